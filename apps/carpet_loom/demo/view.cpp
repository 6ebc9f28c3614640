// Drawing: text with ANSI colours, and nothing that needs a library of the terminal.
#include "apps/carpet_loom/demo/view.hpp"

#include "apps/carpet_loom/wires.hpp"
#include "drivers/can/frame.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>

namespace tappet::demo {

namespace nominal = loom::wires::nominal;

namespace {

constexpr std::size_t most_width = 100;
constexpr std::size_t stops_shown = 5;
constexpr std::size_t messages_shown = 2;
constexpr int bar_cells = 36;

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
    std::array<char, 512> text{};
    va_list values;
    va_start(values, pattern);
    std::vsnprintf(text.data(), text.size(), pattern, values);
    va_end(values);
    return text.data();
}

std::string in_colour(const char* code, const std::string& text) {
    return std::string{"\x1b["} + code + "m" + text + "\x1b[0m";
}
std::string dim(const std::string& text) { return in_colour("2", text); }
std::string yellow(const std::string& text) { return in_colour("33", text); }

std::string of_state(const std::string& state) {
    const std::string word = format("%-10s", state.c_str());
    if (state == "weave") return in_colour("1;32", word);
    if (state == "stopped" || state == "emergency" || state == "fault" || state == "safe")
        return in_colour("1;31", word);
    return in_colour("1;33", word);
}

/// Nothing lost is nothing to look at.
std::string counted(std::int64_t number, const char* what) {
    const std::string text = format("%lld %s", static_cast<long long>(number), what);
    return number == 0 ? text : red(text);
}

const char* bus_name(std::int64_t state) {
    switch (static_cast<can::State>(state)) {
    case can::State::active: return "active";
    case can::State::warning: return "warning";
    case can::State::passive: return "passive";
    case can::State::unacknowledged: return "unacknowledged";
    case can::State::bus_off: return "bus-off";
    case can::State::down: return "down";
    }
    return "unknown";
}

bool bus_good(std::int64_t state) {
    return state >= 0 && state <= 255 && !can::faulted(static_cast<can::State>(state));
}

int cell_of(double value, double least, double most) {
    const double part = std::clamp((value - least) / (most - least), 0.0, 1.0);
    return static_cast<int>(part * (bar_cells - 1) + 0.5);
}

/// A scale with marks on it and the value's dot.
std::string scale(double value, double least, double most, std::initializer_list<double> marks) {
    std::array<const char*, bar_cells> cells{};
    cells.fill("─");
    for (const double mark : marks) cells[static_cast<std::size_t>(cell_of(mark, least, most))] = "┼";
    cells[static_cast<std::size_t>(cell_of(value, least, most))] = "\x1b[0;1;36m●\x1b[0;2m";
    std::string text = "\x1b[2m├";
    for (const char* cell : cells) text += cell;
    return text + "┤\x1b[0m";
}

std::string progress(std::int64_t done, std::int64_t wanted) {
    const int filled =
        cell_of(static_cast<double>(done), 0.0, static_cast<double>(std::max<std::int64_t>(wanted, 1))) +
        (done > 0 ? 1 : 0);
    std::string text;
    for (int cell = 0; cell < bar_cells; ++cell) text += cell < filled ? "█" : "░";
    return text;
}

std::string responses(const Timing& timing, bool coloured) {
    if (timing.responses.empty()) return "not yet measured";
    std::string text;
    for (const Response& response : timing.responses) {
        const std::string word =
            format("%s %lld/%lld", response.activity.c_str(), static_cast<long long>(response.worst_us),
                   static_cast<long long>(response.deadline_us));
        text += (text.empty() ? "" : "  ") +
                (coloured && response.worst_us > response.deadline_us ? red(word) : word);
    }
    return text + " us";
}

std::string cut(const std::string& text) {
    return text.size() <= most_width - 4 ? text : text.substr(0, most_width - 7) + "...";
}

const char* how(const SeenStop& stop) { return stop.at_stop_angle ? "at the stop angle" : "where it was"; }

} // namespace

std::string red(const std::string& text) { return in_colour("1;31", text); }
std::string green(const std::string& text) { return in_colour("1;32", text); }

std::vector<std::string> screen(const Story& story, const Frame& frame) {
    const Status& now = story.status();
    std::vector<std::string> lines;
    const std::string clocks = format("%.1f s of the loom's time, %.0f s of ours",
                                      static_cast<double>(now.time_ms) * 1e-3, frame.wall_s);
    lines.push_back(in_colour("1", "carpet loom") + " on the bench      " + dim(clocks));
    if (!story.begun()) {
        lines.push_back(yellow("booting the emulated box"));
    } else {
        lines.push_back(of_state(now.state) +
                        format(" %4lld rpm      picks ", static_cast<long long>(now.speed_rpm)) +
                        progress(now.picks, frame.picks_wanted) +
                        format(" %lld of %lld", static_cast<long long>(now.picks),
                               static_cast<long long>(frame.picks_wanted)));
        lines.push_back(format("shaft     %4lld deg      ", static_cast<long long>(now.angle_deg)) + " 0° " +
                        scale(static_cast<double>(now.angle_deg), 0.0, 360.0, {nominal::stop_deg}) +
                        format(" ┼ stop angle %.0f°", nominal::stop_deg));
        const double band = nominal::tension_band_n;
        const bool tense = static_cast<double>(now.tension_n) < nominal::tension_n - band ||
                           static_cast<double>(now.tension_n) > nominal::tension_n + band;
        const std::string tension = format("%4lld N", static_cast<long long>(now.tension_n));
        lines.push_back("warp      " + (tense ? yellow(tension) : tension) + "           " +
                        scale(static_cast<double>(now.tension_n), nominal::tension_n - 3.0 * band,
                              nominal::tension_n + 3.0 * band,
                              {nominal::tension_n - band, nominal::tension_n + band}) +
                        format(" ┼ band %.0f ± %.0f N", nominal::tension_n, band));
        const std::string bus = std::string{"CAN "} + bus_name(now.bus_state);
        lines.push_back("wires     " + (bus_good(now.bus_state) ? bus : red(bus)) + ", " +
                        counted(now.frames_lost, "frames lost") + "   GPIO " +
                        counted(now.edges_lost, "edges lost") +
                        format("   Modbus %lld outages", static_cast<long long>(now.outages)));
        lines.push_back(format("oil       %.2f bar", now.oil_bar));
        const std::string misses = counted(story.timing().misses, "deadlines missed");
        lines.push_back("worst     " + responses(story.timing(), true) +
                        (story.timing().responses.empty() ? "" : "   " + misses));
        lines.push_back(format("stops     %zu", story.stops().size()));
    }
    const auto& stops = story.stops();
    for (std::size_t i = stops.size() > stops_shown ? stops.size() - stops_shown : 0; i < stops.size(); ++i) {
        const SeenStop& stop = stops[i];
        const std::string error = stop.at_stop_angle ? format("%+5.1f", stop.error_deg) : "     ";
        lines.push_back(format("  pick %4lld  %-9s  %5.1f°  ", static_cast<long long>(stop.after_pick),
                               stop.cause.c_str(), stop.angle_deg) +
                        error + "  " + dim(how(stop)));
    }
    const auto& messages = story.messages();
    for (std::size_t i = messages.size() > messages_shown ? messages.size() - messages_shown : 0;
         i < messages.size(); ++i)
        lines.push_back(dim("  " + cut(messages[i])));
    return lines;
}

std::string plain_line(const Story& story, const Frame& frame) {
    const Status& now = story.status();
    std::int64_t worst = 0;
    std::int64_t of = 0;
    std::string activity = "none";
    for (const Response& response : story.timing().responses)
        if (of == 0 || response.worst_us * of > worst * response.deadline_us)
            worst = response.worst_us, of = response.deadline_us, activity = response.activity;
    return format("%6.1f s  %-9s %4lld rpm %4lld deg  picks %lld/%lld  warp %lld N  stops %zu  CAN %s, %lld "
                  "lost  edges lost %lld  outages %lld",
                  static_cast<double>(now.time_ms) * 1e-3, now.state.c_str(),
                  static_cast<long long>(now.speed_rpm), static_cast<long long>(now.angle_deg),
                  static_cast<long long>(now.picks), static_cast<long long>(frame.picks_wanted),
                  static_cast<long long>(now.tension_n), story.stops().size(), bus_name(now.bus_state),
                  static_cast<long long>(now.frames_lost), static_cast<long long>(now.edges_lost),
                  static_cast<long long>(now.outages)) +
           (of == 0 ? std::string{}
                    : format("  worst %s %lld/%lld us, %lld misses", activity.c_str(),
                             static_cast<long long>(worst), static_cast<long long>(of),
                             static_cast<long long>(story.timing().misses)));
}

std::string plain_stop(const SeenStop& stop) {
    const std::string where =
        format("          stop after pick %lld, cause %s, at %.1f deg",
               static_cast<long long>(stop.after_pick), stop.cause.c_str(), stop.angle_deg);
    return stop.at_stop_angle ? where + format(", error %+.1f deg", stop.error_deg) : where;
}

} // namespace tappet::demo

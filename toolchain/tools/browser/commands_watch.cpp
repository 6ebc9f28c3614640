// Commands that run until ended: repeated values, and events as they are emitted.
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/reading_text.hpp"
#include "toolchain/tools/browser/screen.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ostream>
#include <thread>

namespace tappet::browser {

namespace {

using Steady = std::chrono::steady_clock;

/// Returns the name that the user uses.
std::string name_of(const Seen& seen) {
    const MapReader& map = seen.session->map();
    return map.place().empty() ? std::string{map.text(map.header().machine)}
                               : map.place().substr(0, map.place().size() - 1);
}

/// Returns which of the watched machines have ended, as a failure; nothing: none has.
Result<void> ended(std::span<const Seen> all, const std::vector<bool>& has_ended) {
    std::string names;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (has_ended[i]) names += (names.empty() ? "" : ", ") + name_of(all[i]);
    if (names.empty()) return {};
    return failure(Fault::no_machine, all.size() == 1
                                          ? "the machine has ended; the last values shown are its last"
                                          : names + " ended; the last values shown are the last");
}

/// Updates which machines have ended. Returns true when all have.
bool all_ended(std::span<const Seen> all, std::vector<bool>& has_ended) {
    for (std::size_t i = 0; i < all.size(); ++i)
        if (!has_ended[i]) has_ended[i] = all[i].session->link().ended();
    return std::ranges::find(has_ended, false) == has_ended.end();
}

WatchRow row_of(const MapReader& map, const Reading& reading, const std::string& last_value) {
    const map::Facet& facet = map.facets()[reading.facet];
    WatchRow row;
    row.name = map.full_name(reading.facet);
    row.value = value_of(map, reading, Style::brief);
    row.unit = map.text(facet.unit);
    row.marks = marks_of(map, reading);
    row.forced = reading.forced;
    row.changed = !last_value.empty() && last_value != row.value;
    return row;
}

std::string title_of(std::span<const Seen> all, long picture) {
    std::string title;
    for (const Seen& each : all) {
        const std::uint32_t forced = each.session->observer().forced();
        title += name_of(each) + "  " + each.session->role() + "  ";
        if (forced > 0) title += std::to_string(forced) + " FORCED  ";
    }
    return title + "picture " + std::to_string(picture);
}

std::vector<WatchRow> rows_of(std::span<const Seen> all, const std::vector<bool>& has_ended,
                              const std::vector<WatchRow>& before) {
    std::vector<WatchRow> rows;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (const Reading& reading : all[i].session->observer().read(all[i].facets)) {
            const std::size_t n = rows.size();
            rows.push_back(
                row_of(all[i].session->map(), reading, n < before.size() ? before[n].value : std::string{}));
            if (has_ended[i]) rows.back().marks = "ended";
        }
    return rows;
}

Result<void> watch_on_screen(Work& work, std::span<const Seen> all) {
    const std::unique_ptr<const Screen> opened =
        work.far_screen ? far_screen(work.out, *work.far_screen, [&work](auto time) { work.pause(time); })
                        : own_screen();
    const Screen& screen = *opened;
    WatchPicture picture;
    picture.status = work.far_screen ? "q or ^C ends" : "q ends";
    std::vector<bool> has_ended(all.size(), false);
    const auto turn = [&](std::ptrdiff_t by) {
        const std::size_t seen = visible_rows(picture, screen.size()), rows = picture.rows.size();
        const auto last = static_cast<std::ptrdiff_t>(rows - std::min(rows, seen));
        picture.first = static_cast<std::size_t>(
            std::clamp(static_cast<std::ptrdiff_t>(picture.first) + by, std::ptrdiff_t{0}, last));
    };
    for (long n = 1; !work.stopped(); ++n) {
        picture.rows = rows_of(all, has_ended, picture.rows);
        picture.title = title_of(all, n);
        screen.show(draw(picture, screen.size(), true));
        if (n == work.line.count) break;
        if (all_ended(all, has_ended)) break;
        const auto until = Steady::now() + work.line.every;
        for (auto left = work.line.every; left.count() > 0;
             left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Steady::now())) {
            const auto key = screen.key(left);
            if (!key) break;
            const auto page = static_cast<std::ptrdiff_t>(visible_rows(picture, screen.size()));
            if (*key == Key::quit) return ended(all, has_ended);
            if (*key == Key::other) continue;
            turn(*key == Key::up ? -1 : *key == Key::down ? 1 : *key == Key::page_up ? -page : page);
            screen.show(draw(picture, screen.size(), true));
        }
    }
    return ended(all, has_ended);
}

/// Reports the end of one machine among others at once: otherwise its values would just stop.
void tell_end(const Work& work, const Seen& seen) {
    if (work.line.json)
        work.out << "{\"machine\": " << in_quotes(name_of(seen)) << ", \"ended\": true}" << std::endl;
    else
        work.out << name_of(seen) << ": the machine has ended" << std::endl;
}

Result<void> watch_in_lines(Work& work, std::span<const Seen> all) {
    auto next = Steady::now();
    std::vector<bool> has_ended(all.size(), false);
    for (long n = 1; !work.stopped(); ++n) {
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (has_ended[i]) continue;
            const MapReader& map = all[i].session->map();
            for (const Reading& reading : all[i].session->observer().read(all[i].facets))
                work.out << (work.line.json ? json_of(map, reading) : line_of(map, reading)) << "\n";
        }
        work.out.flush();
        if (n == work.line.count) break;
        next += work.line.every;
        while (!work.stopped() && Steady::now() < next) {
            std::this_thread::sleep_for(
                std::min<Steady::duration>(next - Steady::now(), std::chrono::milliseconds{100}));
            const std::vector<bool> before = has_ended;
            if (all_ended(all, has_ended)) return ended(all, has_ended);
            for (std::size_t i = 0; i < all.size(); ++i)
                if (has_ended[i] && !before[i]) tell_end(work, all[i]);
        }
    }
    return ended(all, has_ended);
}

void tell_event(Work& work, const Session& from, nlohmann::ordered_json packet) {
    const std::string name = from.map().place() + packet.value("event", std::string{});
    if (work.line.json) {
        packet["event"] = name;
        packet.erase("id");
        work.out << packet.dump() << std::endl;
        return;
    }
    work.out << name << " " << (packet.contains("arguments") ? packet["arguments"].dump() : "[]") << " at "
             << clock_text(packet.value("time_ns", std::int64_t{0}));
    if (const auto lost = packet.value("lost", std::int64_t{0}); lost > 0)
        work.out << ", " << lost << " lost so far";
    if (const auto dropped = packet.value("dropped", std::int64_t{0}); dropped > 0)
        work.out << ", " << dropped << " packets dropped before: read faster";
    work.out << std::endl;
}

Result<void> ask_for_events(const Part& part, const char* verb) {
    for (const std::string& name : part.names)
        if (const auto reply =
                part.session->link().request(verb + (" " + as_word(part.session->map().own_name(name))));
            !reply)
            return std::unexpected(reply.error());
    return {};
}

} // namespace

Result<void> run_watch(Work& work) {
    const auto all = find_seen(work);
    if (!all) return std::unexpected(all.error());
    return work.screen && !work.line.json ? watch_on_screen(work, *all) : watch_in_lines(work, *all);
}

Result<void> run_events(Work& work) {
    std::vector<Part> parts = work.parts();
    for (const Part& part : parts)
        for (const std::string& name : part.names)
            if (const auto found = find_facet(part.session->map(), Takes::event, name); !found)
                return std::unexpected(found.error());
    for (const Part& part : parts)
        if (auto asked = ask_for_events(part, "subscribe"); !asked) return asked;
    Result<void> outcome{};
    const std::chrono::milliseconds patience{100 / parts.size()};
    for (long told = 0; !work.stopped() && !parts.empty();) {
        for (std::size_t i = 0; i < parts.size();) {
            if (work.line.count != 0 && told >= work.line.count) break;
            auto packet = parts[i].session->link().next(patience);
            if (!packet) { // an ended machine does not affect the others
                outcome = std::unexpected(packet.error());
                parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
                continue;
            }
            if (*packet && (*packet)->contains("event")) {
                tell_event(work, *parts[i].session, std::move(**packet));
                ++told;
            }
            ++i;
        }
        if (work.line.count != 0 && told >= work.line.count) break;
    }
    for (const Part& part : parts)
        if (auto asked = ask_for_events(part, "unsubscribe"); !asked) outcome = asked;
    return outcome;
}

} // namespace tappet::browser

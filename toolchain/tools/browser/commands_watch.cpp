// What goes on until it is ended: values again and again, and events as they are emitted.
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

std::unexpected<Failure> ended() {
    return std::unexpected(
        Failure{Fault::no_machine, "the machine has ended; what was shown last is its last"});
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

std::string title_of(Session& session, long picture) {
    const std::uint32_t forced = session.observer().forced();
    std::string title =
        std::string{session.map().text(session.map().header().machine)} + "  " + session.role();
    if (forced > 0) title += "  " + std::to_string(forced) + " FORCED";
    return title + "  picture " + std::to_string(picture);
}

Result<void> watch_on_screen(Work& work, const std::vector<std::uint32_t>& facets) {
    const Screen screen;
    WatchPicture picture;
    picture.status = "q ends";
    const auto turn = [&](std::ptrdiff_t by) {
        const std::size_t seen = visible_rows(picture, screen.size());
        const auto last = static_cast<std::ptrdiff_t>(facets.size() - std::min(facets.size(), seen));
        picture.first = static_cast<std::size_t>(
            std::clamp(static_cast<std::ptrdiff_t>(picture.first) + by, std::ptrdiff_t{0}, last));
    };
    for (long n = 1; !work.stopped(); ++n) {
        const std::vector<WatchRow> before = std::move(picture.rows);
        picture.rows.clear();
        const auto readings = work.session.observer().read(facets);
        for (std::size_t i = 0; i < readings.size(); ++i)
            picture.rows.push_back(
                row_of(work.session.map(), readings[i], before.empty() ? std::string{} : before[i].value));
        picture.title = title_of(work.session, n);
        screen.show(draw(picture, screen.size(), true));
        if (n == work.line.count) return {};
        if (work.session.link().ended()) return ended();
        const auto until = Steady::now() + work.line.every;
        for (auto left = work.line.every; left.count() > 0;
             left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Steady::now())) {
            const auto key = screen.key(left);
            if (!key) break;
            const auto page = static_cast<std::ptrdiff_t>(visible_rows(picture, screen.size()));
            if (*key == Key::quit) return {};
            if (*key == Key::other) continue;
            turn(*key == Key::up ? -1 : *key == Key::down ? 1 : *key == Key::page_up ? -page : page);
            screen.show(draw(picture, screen.size(), true));
        }
    }
    return {};
}

Result<void> watch_in_lines(Work& work, const std::vector<std::uint32_t>& facets) {
    auto next = Steady::now();
    for (long n = 1; !work.stopped(); ++n) {
        for (const Reading& reading : work.session.observer().read(facets))
            work.out << (work.line.json ? json_of(work.session.map(), reading)
                                        : line_of(work.session.map(), reading))
                     << "\n";
        work.out.flush();
        if (n == work.line.count) return {};
        next += work.line.every;
        while (!work.stopped() && Steady::now() < next) {
            std::this_thread::sleep_for(
                std::min<Steady::duration>(next - Steady::now(), std::chrono::milliseconds{100}));
            if (work.session.link().ended()) return ended();
        }
    }
    return {};
}

void tell_event(Work& work, nlohmann::ordered_json packet) {
    if (work.line.json) {
        packet.erase("id");
        work.out << packet.dump() << std::endl;
        return;
    }
    work.out << packet.value("event", std::string{}) << " "
             << (packet.contains("arguments") ? packet["arguments"].dump() : "[]") << " at "
             << clock_text(packet.value("time_ns", std::int64_t{0}));
    if (const auto lost = packet.value("lost", std::int64_t{0}); lost > 0)
        work.out << ", " << lost << " lost so far";
    if (const auto dropped = packet.value("dropped", std::int64_t{0}); dropped > 0)
        work.out << ", " << dropped << " packets dropped before: read faster";
    work.out << std::endl;
}

} // namespace

Result<void> run_watch(Work& work) {
    const auto facets = find_values(work.session.map(), work.arguments());
    if (!facets) return std::unexpected(facets.error());
    return work.screen && !work.line.json ? watch_on_screen(work, *facets) : watch_in_lines(work, *facets);
}

Result<void> run_events(Work& work) {
    for (const std::string& name : work.arguments())
        if (const auto found = find_facet(work.session.map(), Takes::event, name); !found)
            return std::unexpected(found.error());
    Link& link = work.session.link();
    for (const std::string& name : work.arguments())
        if (const auto reply = link.request("subscribe " + as_word(name)); !reply)
            return std::unexpected(reply.error());
    Result<void> outcome{};
    for (long told = 0; !work.stopped() && (work.line.count == 0 || told < work.line.count);) {
        auto packet = link.next(std::chrono::milliseconds{100});
        if (!packet) return std::unexpected(packet.error());
        if (!*packet || !(*packet)->contains("event")) continue;
        tell_event(work, std::move(**packet));
        ++told;
    }
    for (const std::string& name : work.arguments())
        if (const auto reply = link.request("unsubscribe " + as_word(name)); !reply)
            outcome = std::unexpected(reply.error());
    return outcome;
}

} // namespace tappet::browser

// reactions: the time from an edge or a frame to the output that it caused, row by row.
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/value.hpp"

#include <ostream>

namespace tappet::browser {

namespace {

struct Shown {
    std::string row;
    map::Times times;
    bool busy = false;
};

Shown shown(const Work& work, std::string row, std::uint64_t at, std::uint32_t activity) {
    const auto read = work.session.observer().read_times(at, activity);
    return {std::move(row), read.value_or(map::Times{}), !read.has_value()};
}

std::vector<Shown> rows_of(const Work& work) {
    const MapReader& map = work.session.map();
    std::vector<Shown> rows;
    for (const map::Connection& each : map.connections())
        if (each.times_at != 0 && each.from != map::none && each.to != map::none)
            rows.push_back(shown(work, map.full_name(each.from) + " wakes " + map.full_name(each.to),
                                 each.times_at, map.activity_of(map.facets()[each.to])));
    for (const map::Reaction& each : map.reactions())
        if (each.times_at != 0 && each.from != map::none && each.to != map::none)
            rows.push_back(shown(work, map.full_name(each.from) + " tells " + map.full_name(each.to),
                                 each.times_at, each.to_activity));
    return rows;
}

/// Returns "<1us: 3, <2us: 10": non-empty bins only.
std::string histogram_text(const map::Times& times) {
    std::string text;
    for (std::size_t bin = 0; bin < times.histogram.size(); ++bin) {
        if (times.histogram[bin] == 0) continue;
        const bool last = bin + 1 == times.histogram.size();
        text += (text.empty() ? "" : ", ") +
                (last ? ">=" + duration_text((std::int64_t{1} << (bin - 1)) * 1000)
                      : "<" + duration_text((std::int64_t{1} << bin) * 1000)) +
                ": " + std::to_string(times.histogram[bin]);
    }
    return text;
}

} // namespace

Result<void> run_reactions(Work& work) {
    bool any_shown = false;
    for (const Shown& each : rows_of(work)) {
        const map::Times& t = each.times;
        if (t.count == 0 && !each.busy) continue;
        any_shown = true;
        const std::int64_t mean = t.count == 0 ? 0 : t.total_ns / static_cast<std::int64_t>(t.count);
        if (work.line.json) {
            work.out << "{\"row\": " << in_quotes(each.row)
                     << ", \"busy\": " << (each.busy ? "true" : "false") << ", \"count\": " << t.count
                     << ", \"mean_ns\": " << mean << ", \"longest_ns\": " << t.longest_ns
                     << ", \"histogram\": [";
            for (std::size_t bin = 0; bin < t.histogram.size(); ++bin)
                work.out << (bin == 0 ? "" : ", ") << t.histogram[bin];
            work.out << "]}\n";
        } else if (each.busy) {
            work.out << each.row << ": busy\n";
        } else {
            work.out << each.row << ": " << t.count << " times, mean " << moment_text(mean) << ", longest "
                     << moment_text(t.longest_ns) << "\n    " << histogram_text(t) << "\n";
        }
    }
    if (!any_shown && !work.line.json) work.out << "no edge or frame has triggered a row yet\n";
    return {};
}

} // namespace tappet::browser

// The scope: the machine's cycles, present and worst ones, as text and as files for viewers.
#include "toolchain/tools/browser/commands.hpp"
#include "toolchain/tools/browser/value.hpp"
#include "toolchain/tools/browser/waves.hpp"

#include <algorithm>
#include <cstdio>
#include <ostream>
#include <thread>

namespace tappet::browser {

namespace {

using Steady = std::chrono::steady_clock;

/// A tape holds about 100 ms: at this interval nothing is overwritten unread unless the box is too busy.
constexpr std::chrono::milliseconds between_looks{10};
constexpr std::chrono::milliseconds usual_length{1000};

/// Returns "12.345 us": a fixed number of digits, so that times of functions can be compared by eye.
std::string us(std::int64_t ns) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f us", static_cast<double>(ns) / 1000);
    return text;
}

std::string ago(std::int64_t ns) {
    const std::int64_t seconds = std::max<std::int64_t>(0, ns / 1'000'000'000);
    if (seconds >= 120) return std::to_string(seconds / 60) + " min ago";
    return std::to_string(seconds) + " s ago";
}

Result<void> write_file(Work& work, const Waves& waves) {
    const std::string& name = work.line.to;
    const bool vcd = name.ends_with(".vcd");
    if (!vcd && !name.ends_with(".json"))
        return wrong("--to takes a file that ends with .vcd (GTKWave) or .json (ui.perfetto.dev), not '" +
                     name + "'");
    if (const auto written = work.files.write(name, vcd ? as_vcd(waves) : as_trace(waves)); !written)
        return written;
    if (!work.line.json)
        work.out << "written to " << name << ": " << waves.cycles.size() << " cycles in "
                 << us(waves.to - waves.from)
                 << (vcd ? "; open it with gtkwave" : "; open it at ui.perfetto.dev") << "\n";
    return {};
}

/// Returns the cycles within the span, and of one activity when one is named, the worst first.
Result<std::vector<Kept>> worst_of(const ScopeReader& scope, const std::string& activity) {
    auto kept = scope.worst();
    if (!kept) return failure(Fault::too_late, "the machine was recording cycles at each attempt; try again");
    const scope::Directory directory = scope.directory();
    const Waves names = scope.empty();
    if (!activity.empty() &&
        std::ranges::find(names.activities, activity, &WaveActivity::name) == names.activities.end()) {
        std::vector<std::string> all;
        for (const WaveActivity& each : names.activities) all.push_back(each.name);
        const std::string nearest = MapReader::nearest_of(activity, all);
        return wrong("the machine has no activity '" + activity + "'" +
                     (nearest.empty() ? "; info shows them" : nearest));
    }
    const std::int64_t part = std::max<std::int64_t>(1, directory.span_ns / (scope::generations - 1));
    const auto current = static_cast<std::uint64_t>(directory.looked_ns / part);
    std::erase_if(*kept, [&](const Kept& each) {
        const bool old = each.of.generation + scope::generations <= current;
        return old || (!activity.empty() && names.activities[each.of.activity].name != activity);
    });
    // Among several activities, the cycle nearest to its deadline comes first.
    const auto share = [&](const Kept& each) {
        const std::int64_t deadline = names.activities[each.of.activity].deadline_ns;
        return static_cast<double>(each.of.rank_ns) / static_cast<double>(deadline > 0 ? deadline : 1);
    };
    if (activity.empty())
        std::ranges::sort(*kept, {},
                          [&](const Kept& each) { return std::pair{-share(each), each.of.serial}; });
    return std::move(*kept);
}

void tell_blocks(std::ostream& out, const WaveActivity& activity, const WaveCycle& cycle) {
    for (const Block& block : cycle.blocks)
        out << "    " << padded("+" + us(block.begin - cycle.begin), 14, true) << "  "
            << padded(activity.name_of(block.function), 24) << " " << padded(us(block.took()), 14, true)
            << "\n";
    if (cycle.left_out > 0)
        out << "    and " << cycle.left_out << (cycle.left_out == 255 ? " or more" : "")
            << " further functions\n";
}

void tell_worst(std::ostream& out, const ScopeReader& scope, const Kept& kept) {
    const Waves waves = scope.waves_of(kept);
    const WaveActivity& activity = waves.activities[kept.of.activity];
    const std::int64_t response = kept.of.end - kept.of.release;
    out << activity.name << ": " << us(response) << " from release to end";
    if (activity.deadline_ns > 0)
        out << ", of " << duration_text(activity.deadline_ns)
            << (response > activity.deadline_ns ? ": MISSED" : "");
    out << "; began " << us(kept.of.begin - kept.of.release) << " late, " << us(kept.of.end - kept.of.begin)
        << " busy; " << ago(scope.directory().looked_ns - kept.of.end) << "\n";
    std::size_t beside = 0;
    std::int64_t others_ran = 0; // while it waited; on several processors possibly more than the time passed
    for (const WaveCycle& each : waves.cycles)
        if (each.activity == kept.of.activity && each.end == kept.of.end && each.begin == kept.of.begin)
            tell_blocks(out, activity, each);
    for (const WaveCycle& each : waves.cycles) {
        if (each.activity == kept.of.activity && each.begin == kept.of.begin) continue;
        ++beside;
        others_ran += std::max<std::int64_t>(0, std::min(each.end, kept.of.begin) -
                                                    std::max(each.begin, kept.of.release));
        if (each.end < kept.of.release || each.begin > kept.of.end) continue;
        const std::int64_t at = each.begin - kept.of.release;
        out << "  meanwhile " << waves.activities[each.activity].name << ", " << us(at < 0 ? -at : at)
            << (at < 0 ? " before its release" : " after its release") << ", for "
            << us(each.end - each.begin) << "\n";
        tell_blocks(out, waves.activities[each.activity], each);
    }
    if (kept.of.begin > kept.of.release)
        out << "  while it waited to begin, " << us(kept.of.begin - kept.of.release)
            << ", this machine's other cycles ran for " << us(others_ran) << "\n";
    out << "  and " << beside << " cycles from " << us(kept.of.release - waves.from) << " before to "
        << us(waves.to - kept.of.end) << " after it: --to FILE.json or FILE.vcd shows them\n";
}

void tell_worst_json(std::ostream& out, const ScopeReader& scope, const Kept& kept) {
    const Waves waves = scope.waves_of(kept);
    const WaveActivity& activity = waves.activities[kept.of.activity];
    out << "{\"activity\": " << in_quotes(activity.name) << ", \"release_ns\": " << kept.of.release
        << ", \"begin_ns\": " << kept.of.begin << ", \"end_ns\": " << kept.of.end
        << ", \"deadline_ns\": " << activity.deadline_ns << ", \"cycles_around\": " << waves.cycles.size()
        << ", \"functions\": [";
    bool first = true;
    for (const WaveCycle& each : waves.cycles) {
        if (each.activity != kept.of.activity || each.begin != kept.of.begin) continue;
        for (const Block& block : each.blocks) {
            out << (first ? "" : ", ") << "{\"function\": " << in_quotes(activity.name_of(block.function))
                << ", \"begin_ns\": " << block.begin << ", \"took_ns\": " << block.took() << "}";
            first = false;
        }
    }
    out << "]}\n";
}

Result<void> show_worst(Work& work, const ScopeReader& scope, const std::string& activity) {
    const auto kept = worst_of(scope, activity);
    if (!kept) return std::unexpected(kept.error());
    if (kept->empty())
        return wrong("no cycle " + (activity.empty() ? std::string{} : "of '" + activity + "' ") +
                     "is kept yet; cycles of real-time activities are kept some ms after their end");
    const std::size_t count = work.line.count > 0 ? static_cast<std::size_t>(work.line.count) : 1;
    for (std::size_t i = 0; i < std::min(count, kept->size()); ++i)
        (work.line.json ? tell_worst_json : tell_worst)(work.out, scope, (*kept)[i]);
    return work.line.to.empty() ? Result<void>{} : write_file(work, scope.waves_of(kept->front()));
}

Result<void> record(Work& work, const ScopeReader& scope) {
    if (work.line.to.empty()) return wrong("'scope record' needs --to FILE.vcd or --to FILE.json");
    Waves waves = scope.empty();
    std::vector<std::uint64_t> positions;
    for (std::uint32_t a = 0; a < waves.activities.size(); ++a) positions.push_back(scope.tape(a).head());
    const auto end = Steady::now() + (work.line.length.count() > 0 ? work.line.length : usual_length);
    std::size_t gaps = 0;
    for (bool last = false; !last;) {
        last = Steady::now() >= end || work.stopped();
        for (std::uint32_t a = 0; a < waves.activities.size(); ++a)
            if (!scope.follow(a, positions[a], waves)) ++gaps;
        if (!last) std::this_thread::sleep_for(between_looks);
    }
    if (waves.cycles.empty())
        return wrong("no cycle ran meanwhile; is the machine running, and scope.on true?");
    waves.from = waves.to = waves.cycles.front().begin;
    for (const WaveCycle& each : waves.cycles) {
        waves.from = std::min({waves.from, each.release, each.begin});
        waves.to = std::max(waves.to, each.end);
    }
    if (const auto written = write_file(work, waves); !written) return written;
    if (gaps > 0 && !work.line.json)
        work.out << gaps << " times this program came too late, and cycles are missing; is the box busy?\n";
    return {};
}

Result<void> overview(Work& work, const ScopeReader& scope) {
    const scope::Directory directory = scope.directory();
    const Waves names = scope.empty();
    const auto kept = worst_of(scope, {});
    if (!kept) return std::unexpected(kept.error());
    if (!work.line.json)
        work.out << "a stamp costs " << directory.stamp_ns << " ns, which is subtracted; " << directory.judged
                 << " cycles looked at, the worst of " << duration_text(directory.span_ns) << " are kept, by "
                 << (directory.by_busy != 0 ? "busy time" : "response") << "; overtaken "
                 << directory.overtaken << " times\n";
    for (std::uint32_t a = 0; a < names.activities.size(); ++a) {
        const WaveActivity& activity = names.activities[a];
        const Kept* worst = nullptr;
        for (const Kept& each : *kept)
            if (each.of.activity == a && (worst == nullptr || each.of.rank_ns > worst->of.rank_ns))
                worst = &each;
        if (work.line.json) {
            work.out << "{\"activity\": " << in_quotes(activity.name)
                     << ", \"recorded\": " << (scope.tape(a).is_on() ? "true" : "false")
                     << ", \"worst_response_ns\": "
                     << (worst == nullptr ? "null" : std::to_string(worst->of.end - worst->of.release))
                     << ", \"deadline_ns\": " << activity.deadline_ns
                     << ", \"stamp_ns\": " << directory.stamp_ns << "}\n";
            continue;
        }
        work.out << padded(activity.name, 16) << (scope.tape(a).is_on() ? "" : "not recorded; ");
        if (!scope.is_ranked(a)) {
            work.out << "not real-time: recorded, none kept\n";
        } else if (worst == nullptr) {
            work.out << "none kept yet\n";
        } else {
            work.out << padded(us(worst->of.end - worst->of.release), 14, true) << " of "
                     << padded(duration_text(activity.deadline_ns), 6) << " began "
                     << padded(us(worst->of.begin - worst->of.release), 14, true) << " late, busy "
                     << padded(us(worst->of.end - worst->of.begin), 14, true) << ", "
                     << ago(directory.looked_ns - worst->of.end) << "\n";
        }
    }
    return {};
}

} // namespace

Result<void> run_scope(Work& work) {
    const auto scope = ScopeReader::open(work.session.map());
    if (!scope) return failure(Fault::refused, scope.error());
    const auto words = work.arguments();
    if (words.empty()) return overview(work, *scope);
    if (words[0] == "worst")
        return show_worst(work, *scope,
                          words.size() > 1 ? std::string{work.session.map().own_name(words[1])}
                                           : std::string{});
    if (words[0] == "record" && words.size() == 1) return record(work, *scope);
    return wrong("scope has no '" + words[0] + "'; usage: scope, scope worst [ACTIVITY], scope record");
}

} // namespace tappet::browser

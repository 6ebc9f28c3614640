// Reads tapes and kept cycles: places are checked once, words at their use.
#include "toolchain/tools/browser/waves.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <thread>

namespace tappet::browser {

namespace {

constexpr std::array<std::string_view, 4> kinds{"step", "timers", "reactions", "behaviour"};
constexpr int attempts = 64;
constexpr std::chrono::milliseconds between_attempts{5};

/// Decodes a cycle from its marks. The cost of the stamp at a function's end is subtracted.
WaveCycle cycle_from(std::uint32_t activity, const TapeCycle& read, const std::uint64_t* marks,
                     std::int64_t stamp_ns) {
    WaveCycle cycle{activity, read.release, read.begin, read.end, read.left_out};
    std::int64_t begin = read.begin;
    for (std::uint32_t i = 0; i < read.marks; ++i) {
        const TapeMark mark = TapeMark::of(marks[i]);
        const std::int64_t end = read.begin + mark.end;
        cycle.blocks.push_back({mark.function, begin, std::max(begin, end - stamp_ns)});
        begin = end;
    }
    return cycle;
}

/// Decodes the cycles of one activity from words that end with a cycle; returns false on a contradiction.
bool add_cycles(std::uint32_t activity, std::span<const std::uint64_t> words, Waves& into) {
    const std::size_t first = into.cycles.size();
    for (std::size_t after = words.size(); after > 0;) {
        if (after < TapeCycle::words_beside_marks) return false;
        const TapeCycle cycle = cycle_of(words[after - 3], words[after - 2], words[after - 1], after);
        if (cycle.words() > after) return false;
        into.cycles.push_back(cycle_from(activity, cycle, words.data() + cycle.at, into.stamp_ns));
        after = cycle.at;
    }
    std::reverse(into.cycles.begin() + static_cast<std::ptrdiff_t>(first), into.cycles.end());
    return true;
}

} // namespace

std::string WaveActivity::component_of(std::uint32_t function) const {
    const std::size_t part = function / kinds.size();
    return part < components.size() ? components[part] : "component_" + std::to_string(part);
}

std::string_view WaveActivity::kind_of(std::uint32_t function) { return kinds[function % kinds.size()]; }

std::expected<ScopeReader, std::string> ScopeReader::open(const MapReader& map) {
    if (map.header().scope_at == 0)
        return std::unexpected("this machine records no cycles; add component<ThreadScope>(\"scope\") to its "
                               "table, in an activity that is not_real_time");
    ScopeReader reader{map};
    if (const std::string wrong = reader.check(); !wrong.empty())
        return std::unexpected("the machine's scope contradicts itself: " + wrong);
    return reader;
}

std::string ScopeReader::check() {
    const auto* directory = at<scope::Directory>(0);
    if (directory == nullptr) return "it lies outside of the machine's memory";
    std::memcpy(&places_, directory, sizeof places_);
    const std::uint64_t room = map_->view().block().size() - map_->header().scope_at;
    if (places_.tapes != map_->activities().size() || places_.tape_stride < sizeof(scope::Tape))
        return "it has not one tape for each activity";
    for (std::uint32_t a = 0; a < places_.tapes; ++a) {
        const auto* place = at<scope::Tape>(places_.tapes_at + std::uint64_t{a} * places_.tape_stride);
        const auto* tape = place == nullptr ? nullptr : at<CycleTape>(place->at);
        if (tape == nullptr) return "a tape lies outside";
        const std::uint64_t words = tape->capacity();
        if (words < CycleTape::fewest_words || (words & (words - 1)) != 0 || words > room / 8 ||
            CycleTape::bytes_for(words) > room - place->at || tape->most_words() > words / 2)
            return "a tape is longer than its room";
        tapes_.push_back(tape);
        ranked_.push_back(place->ranked != 0);
    }
    const std::uint64_t stride = places_.recording_stride;
    if (stride < sizeof(scope::Recording) || stride % alignof(scope::Recording) != 0 ||
        places_.recordings_at % alignof(scope::Recording) != 0 || places_.recordings_at > room ||
        places_.recordings > (room - places_.recordings_at) / stride)
        return "what it keeps lies outside";
    if (places_.owner >= map_->activities().size()) return "nobody keeps its worst cycles";
    return {};
}

scope::Directory ScopeReader::directory() const {
    scope::Directory now = places_;
    for (int attempt = 0; attempt < attempts; ++attempt)
        if (map_->view().consistent(places_.owner, attempts,
                                    [&] { std::memcpy(&now, at<scope::Directory>(0), sizeof now); }))
            break;
    return now;
}

const CycleTape& ScopeReader::tape(std::uint32_t activity) const { return *tapes_[activity]; }

bool ScopeReader::copy_worst(std::vector<Kept>& into) const {
    return map_->view().consistent(places_.owner, attempts, [&] {
        into.clear();
        for (std::uint32_t i = 0; i < places_.recordings; ++i) {
            const auto* place =
                at<scope::Recording>(places_.recordings_at + std::uint64_t{i} * places_.recording_stride);
            Kept kept;
            std::memcpy(&kept.of, place, sizeof kept.of);
            const std::size_t room =
                (places_.recording_stride - sizeof(scope::Recording)) / sizeof(std::uint64_t);
            if (kept.of.serial == 0 || kept.of.words > room || kept.of.activity >= tapes_.size()) continue;
            kept.words.resize(kept.of.words);
            std::memcpy(kept.words.data(), place + 1, kept.words.size() * sizeof(std::uint64_t));
            into.push_back(std::move(kept));
        }
    });
}

std::optional<std::vector<Kept>> ScopeReader::worst() const {
    std::vector<Kept> found;
    bool whole = false;
    for (int attempt = 0; attempt < attempts && !whole; ++attempt) {
        if (attempt > 0) std::this_thread::sleep_for(between_attempts); // it is in its cycle, or preempted
        whole = copy_worst(found);
    }
    if (!whole) return std::nullopt;
    std::ranges::sort(found, {},
                      [](const Kept& kept) { return std::pair{-kept.of.rank_ns, kept.of.serial}; });
    return found;
}

Waves ScopeReader::empty() const {
    Waves waves;
    waves.machine = map_->text(map_->header().machine);
    waves.stamp_ns = std::max<std::int64_t>(0, directory().stamp_ns);
    for (const map::Activity& each : map_->activities())
        waves.activities.push_back(
            {std::string{map_->text(each.name)}, each.real_time != 0, each.deadline_ns, {}});
    for (const map::Component& each : map_->components()) {
        if (each.activity >= waves.activities.size() || each.position >= map_->components().size()) continue;
        auto& components = waves.activities[each.activity].components;
        if (components.size() <= each.position) components.resize(each.position + 1);
        components[each.position] = map_->text(each.name);
    }
    return waves;
}

Waves ScopeReader::waves_of(const Kept& kept) const {
    Waves waves = empty();
    waves.from = kept.of.from;
    waves.to = kept.of.to;
    const std::span<const std::uint64_t> words{kept.words};
    for (std::size_t at = 0; at < words.size();) {
        const std::uint64_t activity = words[at] >> 48;
        const std::uint64_t count = words[at] & 0xffff'ffff'ffffu;
        if (activity >= waves.activities.size() || count > words.size() - at - 1) break;
        if (!add_cycles(static_cast<std::uint32_t>(activity), words.subspan(at + 1, count), waves)) break;
        at += 1 + count;
    }
    // Cycles across the edge are included whole.
    for (const WaveCycle& each : waves.cycles) {
        waves.from = std::min({waves.from, each.release, each.begin});
        waves.to = std::max(waves.to, each.end);
    }
    return waves;
}

bool ScopeReader::follow(std::uint32_t activity, std::uint64_t& position, Waves& into) const {
    const CycleTape& tape = *tapes_[activity];
    const std::uint64_t head = tape.head();
    const std::size_t first = into.cycles.size();
    bool all = true;
    std::uint64_t after = head;
    while (after > position) {
        TapeCycle cycle;
        all = tape.cycle_before(after, cycle);
        if (!all) break;
        std::vector<std::uint64_t> marks(cycle.marks);
        all = tape.copy(cycle.at, marks);
        if (!all) break;
        into.cycles.push_back(cycle_from(activity, cycle, marks.data(), into.stamp_ns));
        after = cycle.at;
    }
    std::reverse(into.cycles.begin() + static_cast<std::ptrdiff_t>(first), into.cycles.end());
    position = head;
    return all;
}

} // namespace tappet::browser

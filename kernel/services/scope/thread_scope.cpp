// Reads the tapes while the engines write them, and copies the surroundings of each cycle that is worse than
// those kept.
#include "kernel/services/scope/thread_scope.hpp"

#include <algorithm>

namespace tappet {

namespace {

/// Returns the cost of reading the clock once, in ns: the shortest of several rows of readings, which nothing
/// interrupted.
std::int64_t cost_of_stamp(const os::Clock& clock) noexcept {
    constexpr int rows = 64;
    constexpr int readings = 64;
    Duration least = Duration::max();
    for (int row = 0; row < rows; ++row) {
        const Time begin = clock.now();
        Time end = begin;
        for (int i = 0; i < readings; ++i) end = clock.now();
        least = std::min(least, end - begin);
    }
    return least.count() / readings;
}

} // namespace

Sentence ThreadScope::configure(Setup& setup) {
    directory_ = setup.scope;
    clock_ = setup.clock;
    return {};
}

Sentence ThreadScope::initialise() {
    directory_->stamp_ns = cost_of_stamp(*clock_);
    return {};
}

void ThreadScope::work(const Cycle& cycle) {
    if (on.get() != was_on_) turn_tapes();
    if (forgets_ || span.get() != span_used_ || by_busy.get() != by_busy_used_) empty();
    // The time kept after a cycle's end must be on the tapes before they are read.
    const std::int64_t until = to_ns(cycle.now - after.get());
    std::uint32_t rank = 0;
    for (std::uint32_t a = 0; a < directory_->tapes; ++a)
        if (scope::tapes(*directory_)[a].ranked != 0) look(a, rank++, until);
    directory_->looked_ns = until;
    judged.write(static_cast<std::int64_t>(directory_->judged));
    taken.write(static_cast<std::int64_t>(directory_->taken));
}

void ThreadScope::turn_tapes() noexcept {
    was_on_ = on.get();
    for (std::uint32_t a = 0; a < directory_->tapes; ++a) scope::tape(*directory_, a).turn(was_on_);
}

void ThreadScope::empty() noexcept {
    forgets_ = false;
    span_used_ = span.get();
    by_busy_used_ = by_busy.get();
    directory_->span_ns = span_used_.count();
    directory_->by_busy = by_busy_used_ ? 1 : 0;
    for (std::uint32_t i = 0; i < directory_->recordings; ++i)
        scope::recording(*directory_, i) = scope::Recording{};
}

void ThreadScope::look(std::uint32_t activity, std::uint32_t rank, std::int64_t until) noexcept {
    const CycleTape& tape = scope::tape(*directory_, activity);
    std::uint64_t& seen = scope::tapes(*directory_)[activity].judged_until;
    std::uint64_t newest = seen;
    for (std::uint64_t end_at = tape.head(); end_at > seen;) {
        TapeCycle cycle;
        if (!tape.cycle_before(end_at, cycle)) {
            ++directory_->overtaken;
            break;
        }
        end_at = cycle.at;
        if (cycle.end > until) continue;
        newest = std::max(newest, cycle.after);
        ++directory_->judged;
        if (cycle.at != 0) consider(activity, rank, cycle); // the first one warms the caches
    }
    seen = newest;
}

void ThreadScope::consider(std::uint32_t activity, std::uint32_t rank, const TapeCycle& cycle) noexcept {
    const std::int64_t worth = by_busy_used_ ? cycle.busy() : cycle.response();
    const auto generation =
        static_cast<std::uint64_t>(cycle.end / (span_used_.count() / (scope::generations - 1)));
    constexpr std::uint32_t places = scope::generations * scope::kept;
    scope::Recording* oldest = nullptr;
    scope::Recording* least = nullptr;
    std::uint32_t of_now = 0;
    for (std::uint32_t i = 0; i < places; ++i) {
        scope::Recording& each = scope::recording(*directory_, rank * places + i);
        if (each.serial != 0 && each.generation == generation) {
            ++of_now;
            if (least == nullptr || each.rank_ns < least->rank_ns) least = &each;
        } else if (oldest == nullptr || each.serial == 0 ||
                   (oldest->serial != 0 && each.generation < oldest->generation)) {
            oldest = &each; // an empty place is older than any other
        }
    }
    scope::Recording* const into = of_now < scope::kept ? oldest : least;
    if (of_now >= scope::kept && worth <= least->rank_ns) return;
    into->serial = 0;
    into->generation = generation;
    into->rank_ns = worth;
    record(*into, activity, cycle);
}

ThreadScope::Window ThreadScope::window(std::uint32_t activity, std::int64_t from,
                                        std::int64_t to) const noexcept {
    const CycleTape& tape = scope::tape(*directory_, activity);
    Window found;
    TapeCycle cycle;
    for (std::uint64_t end_at = tape.head(); tape.cycle_before(end_at, cycle) && cycle.end >= from;
         end_at = cycle.at) {
        if (cycle.begin > to) continue;
        if (found.after == 0) found.after = cycle.after;
        found.at = cycle.at;
    }
    return found;
}

std::size_t ThreadScope::words_between(std::int64_t from, std::int64_t to) const noexcept {
    std::size_t words = 0;
    for (std::uint32_t a = 0; a < directory_->tapes; ++a)
        if (const Window found = window(a, from, to); found.words() != 0) words += 1 + found.words();
    return words;
}

void ThreadScope::record(scope::Recording& into, std::uint32_t activity, const TapeCycle& cycle) noexcept {
    into.activity = activity;
    into.release = cycle.release;
    into.begin = cycle.begin;
    into.end = cycle.end;
    into.words = 0;
    Duration lead = before.get();
    Duration trail = after.get();
    into.from = cycle.release - lead.count();
    into.to = cycle.end + trail.count();
    // The parts farthest from the cycle are left out first.
    for (int halvings = 0; halvings < 24 && words_between(into.from, into.to) > scope::recording_words;
         ++halvings) {
        lead /= 2;
        trail /= 2;
        into.from = cycle.release - lead.count();
        into.to = cycle.end + trail.count();
    }
    std::uint64_t* const words = scope::words_of(into);
    for (std::uint32_t a = 0; a < directory_->tapes; ++a) {
        const Window found = window(a, into.from, into.to);
        if (found.words() == 0 || into.words + 1 + found.words() > scope::recording_words) continue;
        const std::span<std::uint64_t> room{words + into.words + 1, found.words()};
        if (!scope::tape(*directory_, a).copy(found.at, room)) continue;
        words[into.words] = std::uint64_t{a} << 48 | found.words();
        into.words += static_cast<std::uint32_t>(1 + found.words());
    }
    into.serial = ++directory_->taken;
}

} // namespace tappet

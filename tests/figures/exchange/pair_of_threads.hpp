// Two threads, each alone on a processor, one giving and one taking, and the rhythms in which they may
// exchange.
#pragma once

#include "tests/figures/exchange/machine.hpp"
#include "tests/figures/measure/samples.hpp"
#include "tests/figures/measure/ticks.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace tappet::figures {

/// The results of one meeting, in ns.
struct Meeting {
    Samples seen; ///< from before the giving to the packet taken by the other thread
    Samples give;
    Samples take;
    Samples stream; ///< for each packet, of many in a row
};

/// The number of packets and the longest duration: it respects the share of time that Linux leaves to
/// real-time threads.
struct MeetingPlan {
    std::size_t packets = 2000;
    double longest_ns = 30e6;
    double clock_ahead_ticks = 0; ///< the lead of the taker's time stamps over the giver's
};

/// Runs both at the same time on the first two processors; rests afterwards. Empty: done; else the refusal of
/// the system.
std::string meet(const std::function<void()>& giver, const std::function<void()>& taker);

/// The lead of the second processor's time stamps over the first's, and the one-way time of a cache line that
/// two processors write in turns.
struct Clocks {
    double ahead_ticks = 0;
    Samples one_way_ns{};
};
Clocks compare_clocks(std::size_t rounds);

/// Keeps a value that two processors write apart from its neighbours and from the prefetcher of adjacent
/// lines.
template <class T> struct alignas(128) Line {
    std::atomic<T> value{};
};

using Moments = std::vector<std::uint64_t>;

inline void wait_ticks(std::uint64_t from, double ns) noexcept {
    const auto end = from + static_cast<std::uint64_t>(ns / ns_per_tick());
    while (__rdtsc() < end) {
    }
}

/// At least one tick: the clock cannot resolve less, and the ratio of two such times stays a number.
inline double took_ns(std::uint64_t first, std::uint64_t last) noexcept {
    return std::max(1.0, static_cast<double>(last - first) - ticks_of_reading()) * ns_per_tick();
}

using Parcel = Packet<160>;

/// One packet at a time, while the taker polls without a pause: measures the delay that a reader sees, and
/// the cost of its polling for the writer. Between two packets the writer does other work, as a component
/// does between its cycles.
template <class Subject>
Meeting meet_paced(const MeetingPlan& plan) {
    constexpr double pause_ns = 500;
    Moments begun(plan.packets + 1), ended(plan.packets + 1), seen(plan.packets + 1);
    Line<std::uint64_t> acknowledged, over;
    std::size_t given = 0;
    Parcel in{};
    while (Subject::take(in)) {
    }
    static_cast<void>(meet(
        [&] {
            Parcel out{};
            const std::uint64_t start = ticks();
            for (std::size_t k = 1; k <= plan.packets; ++k) {
                out.words[0] = k;
                begun[k] = ticks();
                while (!Subject::give(out)) {
                }
                ended[k] = ticks();
                while (acknowledged.value.load(std::memory_order_acquire) != k &&
                       took_ns(start, __rdtsc()) < plan.longest_ns) {
                }
                const std::uint64_t now = ticks();
                if (acknowledged.value.load() != k || took_ns(start, now) > plan.longest_ns) break;
                given = k;
                wait_ticks(now, pause_ns);
            }
            over.value.store(1);
        },
        [&] {
            while (over.value.load(std::memory_order_relaxed) == 0)
                if (Subject::take(in)) {
                    const std::uint64_t now = ticks();
                    seen[in.words[0]] = now;
                    acknowledged.value.store(in.words[0], std::memory_order_release);
                }
        }));
    Meeting found;
    for (std::size_t k = 1; k <= given; ++k) {
        const double one_way =
            static_cast<double>(seen[k]) - plan.clock_ahead_ticks - static_cast<double>(begun[k]);
        found.seen.add((one_way - ticks_of_reading()) * ns_per_tick());
        found.give.add(took_ns(begun[k], ended[k]));
    }
    return found;
}

/// The writer alone, in the same rhythm: nobody reads, or with `takes` only the writer itself.
template <class Subject, bool takes>
Meeting write_alone(const MeetingPlan& plan) {
    constexpr double pause_ns = 1000;
    Meeting found;
    Moments begun(plan.packets + 1), ended(plan.packets + 1), taken(plan.packets + 1);
    Parcel out{}, in{};
    static_cast<void>(meet(
        [&] {
            for (std::size_t k = 1; k <= plan.packets; ++k) {
                out.words[0] = k;
                begun[k] = ticks();
                static_cast<void>(Subject::give(out));
                ended[k] = ticks();
                if constexpr (takes) static_cast<void>(Subject::take(in));
                taken[k] = ticks();
                wait_ticks(taken[k], pause_ns);
            }
        },
        [] {}));
    for (std::size_t k = 1; k <= plan.packets; ++k) {
        found.give.add(took_ns(begun[k], ended[k]));
        if constexpr (takes) found.take.add(took_ns(ended[k], taken[k]));
    }
    return found;
}

/// Both without a pause. Only operations that did their work are timed: the worst case that two sides can
/// cause each other.
template <class Subject>
Meeting meet_contended(const MeetingPlan& plan) {
    Moments give_begun(plan.packets), give_ended(plan.packets), take_begun(plan.packets),
        take_ended(plan.packets);
    std::size_t given = 0, taken = 0;
    Line<bool> giver_ready, taker_ready;
    Parcel in{};
    while (Subject::take(in)) {
    }
    // Each side continues after its own last sample until the other one is done.
    const auto side = [&](auto&& operation, Moments& begun, Moments& ended, std::size_t& done,
                          Line<bool>& own, Line<bool>& other) {
        const std::uint64_t start = ticks();
        while (!own.value.load(std::memory_order_relaxed) || !other.value.load(std::memory_order_relaxed)) {
            const std::uint64_t first = ticks();
            const bool worked = operation();
            const std::uint64_t last = ticks();
            if (worked && done < plan.packets) {
                begun[done] = first;
                ended[done] = last;
                ++done;
            }
            if (done == plan.packets || took_ns(start, last) > plan.longest_ns)
                if (!own.value.load(std::memory_order_relaxed)) own.value.store(true);
        }
    };
    static_cast<void>(meet(
        [&] {
            Parcel out{};
            side(
                [&] {
                    ++out.words[0];
                    return Subject::give(out);
                },
                give_begun, give_ended, given, giver_ready, taker_ready);
        },
        [&] {
            side([&] { return Subject::take(in); }, take_begun, take_ended, taken, taker_ready, giver_ready);
        }));
    Meeting found;
    for (std::size_t k = 0; k < given; ++k) found.give.add(took_ns(give_begun[k], give_ended[k]));
    for (std::size_t k = 0; k < taken; ++k) found.take.add(took_ns(take_begun[k], take_ended[k]));
    return found;
}

/// Many packets in a row, without a loss: from the first one given to the last one taken.
template <class Queue>
Meeting meet_in_a_stream(const MeetingPlan& plan) {
    const std::size_t packets = plan.packets * 5;
    std::uint64_t first = 0, last = 0;
    Parcel in{};
    while (Queue::take(in)) {
    }
    static_cast<void>(meet(
        [&] {
            Parcel out{};
            first = ticks();
            for (std::size_t k = 0; k < packets; ++k) {
                out.words[0] = k;
                while (!Queue::give(out)) {
                }
            }
        },
        [&] {
            for (std::size_t k = 0; k < packets; ++k)
                while (!Queue::take(in)) {
                }
            last = ticks();
        }));
    Meeting found;
    found.stream.add(took_ns(first, last) / static_cast<double>(packets));
    return found;
}

} // namespace tappet::figures

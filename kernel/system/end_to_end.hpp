// How long it takes from an event to what it brings about, over processors and wires: event chains, in which
// the end of a step releases the next one, and sampled chains, in which each hop runs by its own period and
// takes what it finds. Whole nanoseconds, in constant expressions.
#pragma once

#include "kernel/machine/check/schedulability.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tappet {

inline constexpr std::size_t no_chain_step = ~std::size_t{0};

/// A task on a processor or a frame on a wire. Load that belongs to no chain is a chain of one step.
struct ChainStep {
    std::size_t resource = 0;    ///< counted from 0
    std::size_t rank = 0;        ///< the lower goes first; on one resource no two are equal
    std::int64_t longest_ns = 0; ///< on the resource, when nothing else is there
    std::int64_t shortest_ns = 0;
    std::size_t after =
        no_chain_step;            ///< the end of which step releases it: of an earlier one; none: an event
    std::int64_t period_ns = 0;   ///< of the event: the least time between two
    std::int64_t jitter_ns = 0;   ///< of the event: the most by which it is late
    std::int64_t blocking_ns = 0; ///< by what is less urgent, where that is not in these steps
};

/// What a time consists of.
enum class TimeTerm : std::uint8_t {
    own,      ///< itself, or those before it of the same step
    jitter,   ///< the lateness with which the steps before bring it
    blocking, ///< something less urgent that has begun
    others,   ///< one that is more urgent
    errors,   ///< of the wire
};

/// What the analysis of a resource answers of one step, from its nominal release, jitter included.
struct ChainStepResponse {
    Response response{};
    TimeTerm largest = TimeTerm::own;
    std::size_t of = 0; ///< by rank, where the term is `blocking` or `others`
    std::int64_t largest_ns = 0;
};

/// Of tasks on one processor, fixed priorities, preemptive, by rank.
constexpr void analyse_processor(std::span<const TaskTiming> by_rank,
                                 std::span<ChainStepResponse> into) noexcept {
    for (std::size_t i = 0; i < by_rank.size(); ++i) {
        const WorstJob worst = worst_job(by_rank, i);
        into[i] = {worst.response, TimeTerm::own, i, worst.jobs * by_rank[i].budget_ns};
        if (!worst.response.bounded) continue;
        if (by_rank[i].blocking_ns > into[i].largest_ns)
            into[i].largest = TimeTerm::blocking, into[i].largest_ns = by_rank[i].blocking_ns;
        for (std::size_t k = 0; k < i; ++k) {
            const analysis::Span window{worst.window_ns + by_rank[k].jitter_ns};
            const std::int64_t ns = analysis::arrivals(window, by_rank[k].period_ns) * by_rank[k].budget_ns;
            if (ns > into[i].largest_ns)
                into[i].largest = TimeTerm::others, into[i].of = k, into[i].largest_ns = ns;
        }
    }
}

/// A step as part of its chain.
struct HopTime {
    /// To the longest time from the event: the end comes at most so long after the latest release. Who is
    /// released earlier, together with the one before, may take longer, and is through by then as well.
    std::int64_t adds_ns = 0;
    std::int64_t jitter_ns = 0; ///< the most by which its release is late; of the first one that of the event
    TimeTerm largest = TimeTerm::own;
    std::size_t of =
        no_chain_step; ///< the step that makes the largest term, where that is `blocking` or `others`
    std::int64_t largest_ns = 0;
};

/// The times of all steps that share resources.
template <std::size_t most> struct EventTimes {
    enum class How : std::uint8_t {
        found,
        too_many,    ///< steps for these arrays
        not_a_step,  ///< `at`: follows itself or a later one, has a negative time, a shortest time above its
                     ///< longest one, or begins without a period
        equal_ranks, ///< `at` and an earlier one, on one resource
        unbounded,   ///< `at`: its resource is overloaded, or may be by what the chains bring to it
        no_end,      ///< releases become later and later; nothing is known
    };
    How how = How::found;
    std::size_t at = no_chain_step;
    std::size_t rounds = 0; ///< of the search
    std::array<HopTime, most> hops{};
    std::array<std::size_t, most> after{};

    [[nodiscard]] constexpr bool bounded() const noexcept { return how == How::found; }
    /// The longest from the nominal time of an event, at which it would be if it were never late, to the end
    /// of that step; only when bounded.
    [[nodiscard]] constexpr std::int64_t from_event(std::size_t step) const noexcept {
        std::int64_t sum = 0;
        for (std::size_t i = step; i < most; i = after[i])
            sum += hops[i].adds_ns + (after[i] == no_chain_step ? hops[i].jitter_ns : 0);
        return sum;
    }
    /// The hop of its way that adds most.
    [[nodiscard]] constexpr std::size_t longest_hop(std::size_t step) const noexcept {
        std::size_t found = step;
        for (std::size_t i = step; i < most; i = after[i])
            if (hops[i].adds_ns > hops[found].adds_ns) found = i;
        return found;
    }
};

/// Rounds over all resources. Chains that cross no resource twice take as many as they have steps.
inline constexpr std::size_t most_chain_rounds = 200;

namespace detail {

template <std::size_t most> class EventSearch {
public:
    using How = typename EventTimes<most>::How;

    constexpr explicit EventSearch(std::span<const ChainStep> steps) noexcept : steps_{steps} {
        if (steps.size() > most) {
            found.how = How::too_many;
            return;
        }
        for (std::size_t i = 0; i < steps.size() && found.bounded(); ++i) add(i);
    }
    template <class Analyse> constexpr void run(const Analyse& analyse) noexcept {
        for (bool again = found.bounded(); again;) {
            if (found.rounds == most_chain_rounds) {
                found.how = How::no_end;
                return;
            }
            ++found.rounds;
            for (std::size_t i = 0; i < steps_.size(); ++i)
                if (stale_[i] && !analyse_resource(steps_[i].resource, analyse)) return;
            again = pass_on();
        }
    }
    EventTimes<most> found{};

private:
    constexpr void add(std::size_t i) noexcept {
        const ChainStep& step = steps_[i];
        const bool begins = step.after == no_chain_step;
        const bool sensible = step.shortest_ns >= 0 && step.shortest_ns <= step.longest_ns &&
                              step.longest_ns <= analysis_max_ns && step.jitter_ns >= 0 &&
                              step.blocking_ns >= 0 && (begins ? step.period_ns > 0 : step.after < i);
        if (!sensible) {
            found.how = How::not_a_step, found.at = i;
            return;
        }
        found.after[i] = step.after;
        period_[i] = begins ? step.period_ns : period_[step.after];
        found.hops[i].jitter_ns = begins ? step.jitter_ns : 0;
        stale_[i] = true;
        std::size_t at = i; // by resource, then by rank
        for (; at > 0; --at) {
            const ChainStep& before = steps_[order_[at - 1]];
            if (before.resource == step.resource && before.rank == step.rank)
                found.how = How::equal_ranks, found.at = i;
            if (before.resource < step.resource ||
                (before.resource == step.resource && before.rank <= step.rank))
                break;
            order_[at] = order_[at - 1];
        }
        order_[at] = i;
    }
    template <class Analyse>
    constexpr bool analyse_resource(std::size_t resource, const Analyse& analyse) noexcept {
        std::size_t first = 0;
        while (steps_[order_[first]].resource != resource) ++first;
        std::size_t count = 0;
        std::array<TaskTiming, most> timings{};
        std::array<ChainStepResponse, most> responses{};
        for (; first + count < steps_.size(); ++count) {
            const std::size_t i = order_[first + count];
            if (steps_[i].resource != resource) break;
            timings[count] = {.period_ns = period_[i],
                              .budget_ns = steps_[i].longest_ns,
                              .deadline_ns = period_[i],
                              .jitter_ns = found.hops[i].jitter_ns,
                              .blocking_ns = steps_[i].blocking_ns};
            stale_[i] = false;
        }
        analyse(resource, std::span<const TaskTiming>{timings}.first(count),
                std::span{responses}.first(count));
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = order_[first + k];
            const ChainStepResponse& answer = responses[k];
            if (!answer.response.bounded) {
                found.how = How::unbounded, found.at = i;
                return false;
            }
            HopTime& hop = found.hops[i];
            hop.adds_ns = answer.response.worst_ns - hop.jitter_ns;
            hop.largest = answer.largest, hop.largest_ns = answer.largest_ns;
            const bool of_another =
                answer.largest == TimeTerm::others || answer.largest == TimeTerm::blocking;
            hop.of =
                of_another && answer.of != k && answer.of < count ? order_[first + answer.of] : no_chain_step;
        }
        return true;
    }
    /// False: nothing came later than it was taken for.
    constexpr bool pass_on() noexcept {
        bool later = false;
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            if (steps_[i].after == no_chain_step) continue;
            const HopTime& before = found.hops[steps_[i].after];
            const std::int64_t jitter_ns =
                before.jitter_ns + before.adds_ns - steps_[steps_[i].after].shortest_ns;
            if (jitter_ns == found.hops[i].jitter_ns) continue;
            found.hops[i].jitter_ns = jitter_ns;
            stale_[i] = later = true;
        }
        return later;
    }

    std::span<const ChainStep> steps_;
    std::array<std::size_t, most> order_{};
    std::array<std::int64_t, most> period_{};
    std::array<bool, most> stale_{};
};

} // namespace detail

/// The holistic analysis of Tindell and Clark 1994: a step is late by what the steps before it may differ in,
/// J = R - least, which makes others late in turn, until nothing becomes later. `analyse(resource, by_rank,
/// into)` answers for the steps of one resource: analyse_processor(by_rank, into), or a wire's analysis.
///     event_times<32>(steps, [](std::size_t resource, std::span<const TaskTiming> by_rank,
///                               std::span<ChainStepResponse> into) { analyse_processor(by_rank, into); })
template <std::size_t most, class Analyse>
constexpr EventTimes<most> event_times(std::span<const ChainStep> steps, const Analyse& analyse) noexcept {
    detail::EventSearch<most> search{steps};
    search.run(analyse);
    return search.found;
}

/// One part of a sampled chain: a task that reads when it begins and writes when it ends, or a frame that is
/// sent by its period. An event chain within is one hop, as if it were a message: the period of its event,
/// and from_event(). Periods are those of nominal releases; an event's is the longest, not the least.
struct SampledHop {
    std::int64_t period_ns = 0;
    std::int64_t response_ns = 0; ///< the longest from a nominal release to the end
    std::int64_t jitter_ns = 0;   ///< the most by which a release is late, contained in the response
    std::size_t resource = 0;
    std::size_t rank = 0; ///< there; the lower goes first
    bool is_message = false;
};

/// What one hop adds to the reaction time.
struct HopShare {
    std::int64_t waits_ns = 0; ///< until it takes the value
    std::int64_t takes_ns = 0; ///< until the value is out again
};

template <std::size_t most> struct SampledTimes {
    bool bounded = false; ///< else the chain has no hop, too many, or one without sense: `at`
    std::size_t at = no_chain_step;
    std::int64_t reaction_ns = 0; ///< the longest from a change outside to the first output that knows it
    std::int64_t age_ns = 0;      ///< the longest from reading a value to the last output that is made of it
    std::int64_t simple_ns = 0;   ///< sum of periods and responses (Davare 2007): never less than the others
    std::array<HopShare, most> shares{}; ///< of reaction_ns
    std::size_t longest = 0;             ///< the hop with the largest share
};

/// Duerr, von der Brueggen, Chen and Chen 2019 (MRT, MDA). A value waits for its consumer while this one's
/// period passes; not for the producer's end as well where both share a processor and the producer goes
/// first, because what was released before the consumer is through before it: only for its lateness.
template <std::size_t most>
constexpr SampledTimes<most> sampled_times(std::span<const SampledHop> hops) noexcept {
    SampledTimes<most> found;
    if (hops.empty() || hops.size() > most) return found;
    for (std::size_t i = 0; i < hops.size(); ++i)
        if (hops[i].period_ns <= 0 || hops[i].response_ns < 0 || hops[i].jitter_ns < 0 ||
            hops[i].jitter_ns > hops[i].response_ns || hops[i].period_ns > analysis_max_ns ||
            hops[i].response_ns > analysis_max_ns) {
            found.at = i;
            return found;
        }
    const auto is_behind = [&](std::size_t i) { // the next one may miss what is on its way
        const SampledHop& hop = hops[i];
        const SampledHop& next = hops[i + 1];
        return hop.is_message || next.is_message || hop.resource != next.resource || hop.rank >= next.rank ||
               hop.response_ns > hop.period_ns;
    };
    found.bounded = true;
    const std::size_t last = hops.size() - 1;
    found.shares[0].waits_ns = hops[0].period_ns;
    found.shares[last].takes_ns = hops[last].response_ns;
    found.age_ns = hops[last].response_ns;
    for (std::size_t i = 0; i < last; ++i) {
        const std::int64_t behind_ns = is_behind(i) ? hops[i].response_ns : hops[i].jitter_ns;
        const bool takes_longer = hops[i].response_ns > hops[i + 1].period_ns + behind_ns;
        found.shares[i].takes_ns = takes_longer ? hops[i].response_ns : behind_ns;
        found.shares[i + 1].waits_ns = takes_longer ? 0 : hops[i + 1].period_ns;
        found.age_ns += hops[i].period_ns + behind_ns;
    }
    for (std::size_t i = 0; i < hops.size(); ++i) {
        const auto share = [&](std::size_t k) { return found.shares[k].waits_ns + found.shares[k].takes_ns; };
        found.simple_ns += hops[i].period_ns + hops[i].response_ns;
        found.reaction_ns += share(i);
        if (share(i) > share(found.longest)) found.longest = i;
    }
    return found;
}

} // namespace tappet

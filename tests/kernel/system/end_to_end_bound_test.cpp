// Nothing takes longer in a simulated system than is proven of it, over many seeds: random chains over
// processors with fixed priorities and wires with arbitration. What each part of the analysis is for, a run
// without it shows.
#include "kernel/base/random.hpp"
#include "kernel/system/end_to_end.hpp"
#include "tests/kernel/system/wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <vector>

namespace tappet {
namespace {

constexpr std::int64_t ms = 1'000'000, us = 1'000;
constexpr std::int64_t bit_ns = 2 * us;
constexpr std::size_t most = 64;

/// What a seed makes of a system: event chains, and one sampled chain whose hops are steps of their own.
struct World {
    std::size_t processors = 0, wires = 0;
    std::vector<ChainStep> steps;
    std::vector<std::size_t> sampled; ///< the hops of the sampled chain
    [[nodiscard]] bool is_wire(std::size_t resource) const { return resource >= processors; }
};

World world_of(Random& random) {
    World world;
    world.processors = 1 + random.below(3);
    world.wires = 1 + random.below(2);
    const auto step_on = [&](std::size_t resource, std::int64_t period_ns) {
        ChainStep step{.resource = resource};
        step.longest_ns = world.is_wire(resource) ? random.between(60, 800) * us
                                                  : period_ns * random.between(10, 250) / 1000;
        step.shortest_ns = random.one_in(2) ? 0 : random.between(0, step.longest_ns);
        return step;
    };
    constexpr std::array periods_ms{5, 10, 20, 40, 80};
    const std::size_t chains = 2 + random.below(4);
    for (std::size_t chain = 0; chain < chains; ++chain) {
        const std::int64_t period_ns = periods_ms[random.below(periods_ms.size())] * ms;
        const std::size_t hops = 1 + random.below(5);
        for (std::size_t hop = 0; hop < hops; ++hop) {
            ChainStep step = step_on(random.below(world.processors + world.wires), period_ns);
            if (hop == 0) {
                step.period_ns = period_ns;
                step.jitter_ns = random.one_in(2) ? 0 : random.between(0, period_ns / 2);
            } else {
                step.after = world.steps.size() - 1;
            }
            world.steps.push_back(step);
        }
    }
    const std::size_t hops = 2 + random.below(3);
    for (std::size_t hop = 0; hop < hops; ++hop) {
        const std::int64_t period_ns = periods_ms[random.below(periods_ms.size())] * ms;
        const std::size_t resource = random.one_in(4)   ? world.processors
                                     : random.one_in(2) ? 0
                                                        : random.below(world.processors);
        ChainStep step = step_on(resource, period_ns);
        step.period_ns = period_ns;
        step.jitter_ns = random.one_in(2) ? 0 : random.between(0, period_ns / 2);
        world.sampled.push_back(world.steps.size());
        world.steps.push_back(step);
    }
    std::vector<std::size_t> ranks(world.steps.size());
    for (std::size_t i = 0; i < ranks.size(); ++i) ranks[i] = i;
    for (std::size_t i = ranks.size(); i > 1; --i) std::swap(ranks[i - 1], ranks[random.below(i)]);
    for (std::size_t i = 0; i < ranks.size(); ++i) world.steps[i].rank = ranks[i];
    return world;
}

/// A chain whose second step comes soon or late, above one that waits for it.
World uneven(Random& random) {
    World world;
    world.processors = 3, world.wires = 1;
    const std::int64_t first_ns = random.between(2'000, 4'000) * us;
    world.steps = {
        {.resource = 0, .rank = 0, .longest_ns = first_ns, .shortest_ns = 0, .period_ns = 5 * ms},
        {.resource = 1, .rank = 0, .longest_ns = 2 * ms, .shortest_ns = 2 * ms, .after = 0},
        {.resource = 1, .rank = 1, .longest_ns = 2 * ms, .shortest_ns = 2 * ms, .period_ns = 40 * ms},
        {.resource = 2, .rank = 0, .longest_ns = 1 * ms, .shortest_ns = 1 * ms, .period_ns = 10 * ms},
        {.resource = 2, .rank = 1, .longest_ns = 1 * ms, .shortest_ns = 1 * ms, .period_ns = 10 * ms}};
    world.sampled = {3, 4};
    return world;
}

/// The longest that was seen: per step from the nominal time of its event to its end, and of the sampled
/// chain.
struct Seen {
    std::vector<std::int64_t> from_event;
    std::int64_t reaction_ns = 0, age_ns = 0;
};

class SystemRun {
public:
    SystemRun(const World& world, Random& random)
        : world_{world},
          random_{random},
          queues_(world.processors + world.wires),
          running_(queues_.size(), none),
          samples_(world.steps.size(), none) {
        seen_.from_event.resize(world.steps.size());
        const bool together = random_.one_in(2);
        for (const ChainStep& step : world_.steps) {
            const bool begins = step.after == no_chain_step;
            nominal_.push_back(begins && !together ? random_.between(0, step.period_ns) : begins ? 0 : never);
            arrives_.push_back(never);
        }
        for (std::size_t i = 0; i < nominal_.size(); ++i)
            if (nominal_[i] != never) arrives_[i] = nominal_[i] + lateness(i);
    }

    const Seen& run(std::int64_t length) {
        for (std::int64_t now = 0; now < length;) {
            std::int64_t next = *std::ranges::min_element(arrives_);
            for (std::size_t r = 0; r < queues_.size(); ++r)
                if (running_[r] != none) next = std::min(next, now + job(r).left_ns);
            for (std::size_t r = 0; r < queues_.size(); ++r)
                if (running_[r] != none) job(r).left_ns -= next - now;
            now = next;
            for (std::size_t r = 0; r < queues_.size(); ++r)
                if (running_[r] != none && job(r).left_ns == 0) end(r, now);
            for (std::size_t i = 0; i < arrives_.size(); ++i)
                if (arrives_[i] == now) {
                    release(i, nominal_[i]);
                    nominal_[i] += world_.steps[i].period_ns;
                    arrives_[i] = std::max(now + 1, nominal_[i] + lateness(i));
                }
            for (std::size_t r = 0; r < queues_.size(); ++r) dispatch(r, now);
        }
        return seen_;
    }

private:
    static constexpr std::int64_t never = analysis_max_ns;
    static constexpr std::size_t none = no_chain_step;
    struct Job {
        std::size_t step = 0;
        std::int64_t event = 0, left_ns = 0;
        bool begun = false;
        std::size_t sample = none; ///< of the first hop of the sampled chain
    };
    Job& job(std::size_t resource) { return queues_[resource][running_[resource]]; }

    std::int64_t lateness(std::size_t i) {
        const std::int64_t jitter_ns = world_.steps[i].jitter_ns;
        return random_.one_in(2) ? jitter_ns : random_.between(0, jitter_ns);
    }
    void release(std::size_t i, std::int64_t event) {
        const ChainStep& step = world_.steps[i];
        Job next{.step = i, .event = event, .left_ns = step.longest_ns};
        if (random_.one_in(4))
            next.left_ns = std::max<std::int64_t>(1, step.shortest_ns);
        else if (random_.one_in(4))
            next.left_ns = random_.between(next.left_ns / 2 + step.shortest_ns / 2, next.left_ns);
        if (world_.is_wire(step.resource)) next.sample = input_of(i); // what is queued is what is sent
        queues_[step.resource].push_back(next);
    }
    [[nodiscard]] std::size_t input_of(std::size_t i) const {
        for (std::size_t hop = 1; hop < world_.sampled.size(); ++hop)
            if (world_.sampled[hop] == i) return samples_[world_.sampled[hop - 1]];
        return none;
    }
    void dispatch(std::size_t resource, std::int64_t now) {
        if (world_.is_wire(resource) && running_[resource] != none) return;
        auto& queue = queues_[resource];
        running_[resource] = none;
        for (std::size_t k = 0; k < queue.size(); ++k)
            if (running_[resource] == none ||
                world_.steps[queue[k].step].rank < world_.steps[job(resource).step].rank)
                running_[resource] = k;
        if (running_[resource] == none || job(resource).begun) return;
        Job& next = job(resource);
        next.begun = true;
        if (next.step == world_.sampled.front()) {
            next.sample = reads_.size();
            reads_.push_back(now);
        } else if (!world_.is_wire(resource)) {
            next.sample = input_of(next.step);
        }
    }
    void end(std::size_t resource, std::int64_t now) {
        const Job done = job(resource);
        queues_[resource].erase(queues_[resource].begin() + static_cast<std::ptrdiff_t>(running_[resource]));
        running_[resource] = none;
        seen_.from_event[done.step] = std::max(seen_.from_event[done.step], now - done.event);
        if (done.sample != none) {
            samples_[done.step] = done.sample;
            if (done.step == world_.sampled.back()) react(done.sample, now);
        }
        for (std::size_t i = 0; i < world_.steps.size(); ++i)
            if (world_.steps[i].after == done.step) release(i, done.event);
    }
    /// An event just after a reading waits for the next one.
    void react(std::size_t sample, std::int64_t now) {
        seen_.age_ns = std::max(seen_.age_ns, now - reads_[sample]);
        for (; reacted_ <= sample; ++reacted_)
            if (reacted_ > 0) seen_.reaction_ns = std::max(seen_.reaction_ns, now - reads_[reacted_ - 1]);
    }

    const World& world_;
    Random& random_;
    std::vector<std::deque<Job>> queues_;
    std::vector<std::size_t> running_;
    std::vector<std::size_t> samples_; ///< what each step has put out
    std::vector<std::int64_t> nominal_, arrives_;
    std::vector<std::int64_t> reads_;
    std::size_t reacted_ = 0;
    Seen seen_;
};

struct Judgement {
    int systems = 0;
    int broken = 0;
    double nearest_step = 0, nearest_chain = 0, nearest_reaction = 0, nearest_age = 0; ///< observed / proven
};

/// What of the analysis is left out.
enum class Without { nothing, jitter, blocking, shortest_times, foreign_producers, lateness };

auto analysis_of(const World& world, Without without) {
    return [&world, without](std::size_t resource, std::span<const TaskTiming> by_rank,
                             std::span<ChainStepResponse> into) {
        std::vector<TaskTiming> timings(by_rank.begin(), by_rank.end());
        if (without == Without::jitter)
            for (TaskTiming& timing : timings) timing.jitter_ns = 0;
        if (world.is_wire(resource) && without != Without::blocking)
            test::analyse_wire(timings, into, bit_ns);
        else
            analyse_processor(timings, into);
        if (without == Without::jitter)
            for (std::size_t i = 0; i < into.size(); ++i) into[i].response.worst_ns += by_rank[i].jitter_ns;
    };
}

SampledTimes<8> sampled_of(const World& world, const EventTimes<most>& times, Without without) {
    std::vector<SampledHop> hops;
    for (const std::size_t i : world.sampled) {
        const ChainStep& step = world.steps[i];
        hops.push_back({.period_ns = step.period_ns,
                        .response_ns = times.from_event(i),
                        .jitter_ns = step.jitter_ns,
                        .resource = step.resource,
                        .rank = step.rank,
                        .is_message = world.is_wire(step.resource)});
        if (without == Without::foreign_producers) // each is one that goes first beside its consumer
            hops.back().resource = 0, hops.back().rank = hops.size(), hops.back().is_message = false;
        if (without == Without::lateness) hops.back().jitter_ns = 0;
    }
    return sampled_times<8>(hops);
}

Judgement judge(int seeds, Without without, World (*make)(Random&) = world_of) {
    Judgement found;
    const auto look = [&](std::int64_t seen, std::int64_t proven, double& nearest) {
        const double ratio = static_cast<double>(seen) / static_cast<double>(proven);
        nearest = std::max(nearest, ratio);
        found.broken += ratio > 1.0 ? 1 : 0;
    };
    for (int seed = 1; seed <= seeds; ++seed) {
        Random random{static_cast<std::uint64_t>(seed)};
        const World world = make(random);
        if (!event_times<most>(world.steps, analysis_of(world, Without::nothing)).bounded()) continue;
        ++found.systems;
        const Seen seen = SystemRun{world, random}.run(800 * ms);
        std::vector<ChainStep> believed = world.steps;
        if (without == Without::shortest_times)
            for (ChainStep& step : believed) step.shortest_ns = step.longest_ns;
        const auto times = event_times<most>(believed, analysis_of(world, without));
        for (std::size_t i = 0; i < world.steps.size(); ++i)
            look(seen.from_event[i], times.from_event(i),
                 world.steps[i].after == no_chain_step ? found.nearest_step : found.nearest_chain);
        const auto sampled = sampled_of(world, times, without);
        EXPECT_TRUE(sampled.bounded);
        EXPECT_LE(sampled.reaction_ns, sampled.simple_ns);
        EXPECT_LE(sampled.age_ns, sampled.simple_ns);
        look(seen.reaction_ns, sampled.reaction_ns, found.nearest_reaction);
        look(seen.age_ns, sampled.age_ns, found.nearest_age);
    }
    return found;
}

TEST(EndToEndBound, holds_over_a_thousand_seeds_and_is_near) {
    const Judgement found = judge(1000, Without::nothing);
    std::printf("%d systems; nearest: chains %.3f, reaction %.3f, age %.3f\n", found.systems,
                found.nearest_chain, found.nearest_reaction, found.nearest_age);
    EXPECT_GT(found.systems, 300);
    EXPECT_EQ(found.broken, 0);
    EXPECT_GE(found.nearest_step, 0.7);
    EXPECT_GE(found.nearest_chain, 0.7);
    EXPECT_GE(found.nearest_reaction, 0.7);
    EXPECT_GE(found.nearest_age, 0.7);
}

TEST(EndToEndBound, is_broken_without_each_part_of_the_analysis) {
    for (const Without each :
         {Without::jitter, Without::blocking, Without::foreign_producers, Without::lateness})
        EXPECT_GT(judge(1000, each).broken, 0) << static_cast<int>(each);
    EXPECT_EQ(judge(100, Without::nothing, uneven).broken, 0);
    EXPECT_GT(judge(100, Without::shortest_times, uneven).broken, 0);
}

} // namespace
} // namespace tappet

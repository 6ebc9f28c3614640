// End-to-end times: published systems to the digit, and what each part of the analysis adds to them; what
// cannot be answered, and why.
#include "kernel/system/end_to_end.hpp"
#include "tests/kernel/system/wire.hpp"

#include <gtest/gtest.h>

#include <array>

namespace tappet {
namespace {

constexpr std::int64_t ms = 1'000'000, us = 1'000;

/// Resources that the tests know by number: processors, and the net as one of two kinds.
constexpr std::size_t cpu1 = 0, cpu2 = 1, net = 2;
constexpr auto with_preemptive_net = [](std::size_t, auto by_rank, auto into) {
    analyse_processor(by_rank, into);
};
constexpr auto with_wire = [](std::size_t resource, auto by_rank, auto into) {
    if (resource == net)
        test::analyse_wire(by_rank, into, 1);
    else
        analyse_processor(by_rank, into);
};
/// Faults: nothing comes late; nobody else is there. with_preemptive_net is one where a net is a wire.
constexpr auto without_jitter = [](std::size_t resource, auto by_rank, auto into) {
    std::array<TaskTiming, 16> all{};
    for (std::size_t i = 0; i < by_rank.size(); ++i) {
        all[i] = by_rank[i];
        all[i].jitter_ns = 0;
    }
    with_wire(resource, std::span<const TaskTiming>{all}.first(by_rank.size()), into);
    for (std::size_t i = 0; i < by_rank.size(); ++i) into[i].response.worst_ns += by_rank[i].jitter_ns;
};

constexpr auto without_others = [](std::size_t resource, auto by_rank, auto into) {
    for (std::size_t i = 0; i < by_rank.size(); ++i)
        with_wire(resource, by_rank.subspan(i, 1), into.subspan(i, 1));
};

// Palencia and Gonzalez Harbour: one transaction every 30 and one every 40 ms over two processors and a net.
constexpr std::array palencia{
    ChainStep{.resource = cpu1, .rank = 1, .longest_ns = 5 * ms, .period_ns = 30 * ms},
    ChainStep{.resource = net, .rank = 2, .longest_ns = 2 * ms, .after = 0},
    ChainStep{.resource = cpu2, .rank = 2, .longest_ns = 20 * ms, .after = 1},
    ChainStep{.resource = cpu2, .rank = 1, .longest_ns = 5 * ms, .period_ns = 40 * ms},
    ChainStep{.resource = net, .rank = 1, .longest_ns = 10 * ms, .after = 3},
    ChainStep{.resource = cpu1, .rank = 2, .longest_ns = 10 * ms, .after = 4},
};
constexpr auto palencia_preemptive = event_times<6>(palencia, with_preemptive_net);
static_assert(palencia_preemptive.bounded());
static_assert(palencia_preemptive.from_event(2) == 42 * ms);
static_assert(palencia_preemptive.from_event(5) == 30 * ms);
constexpr auto palencia_on_can = event_times<6>(palencia, with_wire);
static_assert(palencia_on_can.from_event(2) == 42 * ms);
static_assert(palencia_on_can.from_event(5) == 32 * ms, "the frame of 2 ms has just begun");
static_assert(event_times<6>(palencia, without_others).from_event(2) == 27 * ms &&
              event_times<6>(palencia, without_others).from_event(5) == 25 * ms);
static_assert(palencia_on_can.longest_hop(2) == 2);
static_assert(palencia_on_can.hops[2].largest == TimeTerm::own &&
              palencia_on_can.hops[2].largest_ns == 20 * ms);
static_assert(palencia_on_can.hops[4].adds_ns == 12 * ms);
static_assert(palencia_on_can.hops[1].largest == TimeTerm::others && palencia_on_can.hops[1].of == 4);

// The tutorial of pycpa: two chains over two processors and a bus.
constexpr std::array pycpa{
    ChainStep{.resource = cpu1,
              .rank = 1,
              .longest_ns = 10 * ms,
              .shortest_ns = 5 * ms,
              .period_ns = 30 * ms,
              .jitter_ns = 3 * ms},
    ChainStep{.resource = cpu1,
              .rank = 2,
              .longest_ns = 3 * ms,
              .shortest_ns = 1 * ms,
              .period_ns = 15 * ms,
              .jitter_ns = 1 * ms},
    ChainStep{.resource = net, .rank = 1, .longest_ns = 2 * ms, .shortest_ns = 2 * ms, .after = 0},
    ChainStep{.resource = net, .rank = 2, .longest_ns = 9 * ms, .shortest_ns = 5 * ms, .after = 1},
    ChainStep{.resource = cpu2, .rank = 1, .longest_ns = 3 * ms, .shortest_ns = 2 * ms, .after = 3},
    ChainStep{.resource = cpu2, .rank = 2, .longest_ns = 5 * ms, .shortest_ns = 3 * ms, .after = 2},
};
constexpr auto of_pycpa = event_times<6>(pycpa, with_wire);
constexpr bool has_responses(const EventTimes<6>& found, const std::array<std::int64_t, 6>& expected_ms) {
    for (std::size_t i = 0; i < expected_ms.size(); ++i)
        if (found.hops[i].adds_ns != expected_ms[i] * ms) return false;
    return found.bounded();
}
static_assert(has_responses(of_pycpa, {10, 13, 11, 11, 3, 11}));
static_assert(of_pycpa.from_event(5) - 3 * ms == 32 * ms, "which counts from an event that is late already");
static_assert(of_pycpa.from_event(4) - 1 * ms == 27 * ms);
static_assert(of_pycpa.hops[5].largest == TimeTerm::others && of_pycpa.hops[5].of == 4 &&
              of_pycpa.hops[5].largest_ns == 6 * ms);
static_assert(of_pycpa.hops[2].largest == TimeTerm::blocking && of_pycpa.hops[2].of == 3);
static_assert(!has_responses(event_times<6>(pycpa, without_jitter), {10, 13, 11, 11, 3, 11}));
static_assert(!has_responses(event_times<6>(pycpa, with_preemptive_net), {10, 13, 11, 11, 3, 11}));
constexpr auto without_least = [] {
    auto steps = pycpa;
    for (ChainStep& step : steps) step.shortest_ns = 0;
    return event_times<6>(steps, with_wire);
}();
static_assert(!without_least.bounded() || without_least.from_event(5) > 35 * ms,
              "who says no shortest time is later than need be");

// Rox and Ernst 2010: a bus alone.
constexpr std::array rox{
    ChainStep{.resource = net, .rank = 1, .longest_ns = 976 * us, .period_ns = 15 * ms},
    ChainStep{.resource = net, .rank = 2, .longest_ns = 736 * us, .period_ns = 30 * ms},
    ChainStep{.resource = net, .rank = 3, .longest_ns = 1056 * us, .period_ns = 75 * ms},
    ChainStep{.resource = net, .rank = 4, .longest_ns = 1056 * us, .period_ns = 40 * ms},
    ChainStep{.resource = net, .rank = 5, .longest_ns = 736 * us, .period_ns = 15 * ms},
};
constexpr auto of_rox = event_times<5>(rox, with_wire);
static_assert(of_rox.from_event(0) == 2032 * us && of_rox.from_event(1) == 2768 * us &&
              of_rox.from_event(2) == 3824 * us && of_rox.from_event(3) == 4560 * us &&
              of_rox.from_event(4) == 4560 * us);
static_assert(event_times<5>(rox, with_preemptive_net).from_event(0) == 976 * us);

// Duerr's tool, and Davare's sum: (5, 2) (10, 0.54) (20, 6), each on a processor of its own.
constexpr std::array duerr{SampledHop{5 * ms, 2 * ms, 0, 0}, SampledHop{10 * ms, 540 * us, 0, 1},
                           SampledHop{20 * ms, 6 * ms, 0, 2}};
constexpr auto of_duerr = sampled_times<3>(duerr);
static_assert(of_duerr.bounded && of_duerr.reaction_ns == 43'540 * us && of_duerr.age_ns == 23'540 * us &&
              of_duerr.simple_ns == 43'540 * us);
static_assert(of_duerr.longest == 2 && of_duerr.shares[2].waits_ns == 20 * ms &&
              of_duerr.shares[2].takes_ns == 6 * ms);

/// The same chain, its hops where they are told to stand.
constexpr auto duerr_with(std::array<std::size_t, 3> resources, std::array<std::size_t, 3> ranks,
                          std::size_t message = no_chain_step) {
    auto hops = duerr;
    for (std::size_t i = 0; i < hops.size(); ++i) {
        hops[i].resource = resources[i], hops[i].rank = ranks[i];
        hops[i].is_message = i == message;
    }
    return sampled_times<3>(hops);
}
static_assert(duerr_with({0, 0, 0}, {1, 2, 3}).reaction_ns == 41 * ms, "P = 0: 5 + 10 + 20 + 6");
static_assert(duerr_with({0, 0, 0}, {1, 2, 3}).age_ns == 21 * ms, "5 + 10 + 6");
static_assert(duerr_with({0, 0, 0}, {3, 2, 1}).reaction_ns == 43'540 * us, "the consumer goes first");
static_assert(duerr_with({0, 0, 0}, {1, 2, 2}).reaction_ns == 41'540 * us, "nobody knows who goes first");
static_assert(duerr_with({0, 0, 1}, {1, 2, 3}).reaction_ns == 41'540 * us);
static_assert(duerr_with({0, 0, 0}, {1, 2, 3}, 1).reaction_ns == 43'540 * us, "a frame on the way");

TEST(SampledTimes, count_a_producer_that_takes_longer_than_its_consumer_waits) {
    const std::array hops{SampledHop{50 * ms, 40 * ms, 0, 0, 1}, SampledHop{10 * ms, 5 * ms, 0, 0, 2}};
    const auto found = sampled_times<2>(hops);
    EXPECT_EQ(found.reaction_ns, (50 + 40 + 5) * ms) << "max(R1, T2)";
    EXPECT_EQ(found.shares[0].takes_ns, 40 * ms);
    EXPECT_EQ(found.shares[1].waits_ns, 0);
    EXPECT_EQ(found.longest, 0u);
    EXPECT_LE(found.reaction_ns, found.simple_ns);
}

TEST(SampledTimes, of_a_producer_that_outlasts_its_period_are_those_of_strangers) {
    const std::array hops{SampledHop{10 * ms, 15 * ms, 0, 0, 1}, SampledHop{100 * ms, 50 * ms, 0, 0, 2}};
    EXPECT_EQ(sampled_times<2>(hops).reaction_ns, (10 + 15 + 100 + 50) * ms);
    EXPECT_EQ(sampled_times<2>(hops).age_ns, (10 + 15 + 50) * ms);
}

TEST(SampledTimes, of_a_producer_that_goes_first_but_late) {
    const std::array hops{SampledHop{10 * ms, 5 * ms, 3 * ms, 0, 1}, SampledHop{20 * ms, 6 * ms, 0, 0, 2}};
    EXPECT_EQ(sampled_times<2>(hops).reaction_ns, (10 + 3 + 20 + 6) * ms);
    EXPECT_EQ(sampled_times<2>(hops).age_ns, (10 + 3 + 6) * ms);
}

TEST(SampledTimes, of_nothing_and_of_nonsense_are_none) {
    EXPECT_FALSE(sampled_times<3>({}).bounded);
    EXPECT_FALSE(sampled_times<2>(duerr).bounded) << "no room";
    for (const SampledHop& bad :
         {SampledHop{0, 1}, SampledHop{-1, 1}, SampledHop{1, -1}, SampledHop{1, 1, -1}, SampledHop{1, 1, 2},
          SampledHop{analysis_max_ns + 1, 1}, SampledHop{1, analysis_max_ns + 1}}) {
        const std::array hops{duerr[0], bad};
        EXPECT_FALSE(sampled_times<3>(hops).bounded);
        EXPECT_EQ(sampled_times<3>(hops).at, 1u);
    }
}

TEST(EventTimes, of_published_systems_are_the_same_at_run_time) {
    EXPECT_EQ(event_times<16>(palencia, with_wire).from_event(2), 42 * ms);
    EXPECT_EQ(event_times<16>(palencia, with_wire).from_event(5), 32 * ms);
    EXPECT_EQ(event_times<16>(pycpa, with_wire).from_event(5), (3 + 32) * ms);
    EXPECT_EQ(event_times<16>(pycpa, with_wire).from_event(4), (1 + 27) * ms);
    EXPECT_EQ(event_times<16>(rox, with_wire).from_event(4), 4560 * us);
    EXPECT_EQ(sampled_times<16>(duerr).reaction_ns, 43'540 * us);
}

TEST(EventTimes, need_what_the_chains_bring_late) {
    const std::array crossing{
        ChainStep{
            .resource = cpu1, .rank = 1, .longest_ns = 4 * ms, .period_ns = 10 * ms, .jitter_ns = 8 * ms},
        ChainStep{.resource = cpu1, .rank = 2, .longest_ns = 4 * ms, .period_ns = 50 * ms},
    };
    EXPECT_EQ(event_times<2>(crossing, with_wire).from_event(1), 12 * ms);
    EXPECT_EQ(event_times<2>(crossing, without_jitter).from_event(1), 8 * ms);
}

TEST(EventTimes, are_found_when_chains_cross_in_a_circle) {
    // Each makes the other one late on the next processor.
    const std::array circle{
        ChainStep{.resource = cpu1, .rank = 2, .longest_ns = 3 * ms, .period_ns = 10 * ms},
        ChainStep{.resource = cpu2, .rank = 1, .longest_ns = 3 * ms, .after = 0},
        ChainStep{.resource = cpu2, .rank = 2, .longest_ns = 3 * ms, .period_ns = 10 * ms},
        ChainStep{.resource = cpu1, .rank = 1, .longest_ns = 3 * ms, .after = 2},
    };
    const auto found = event_times<4>(circle, with_wire);
    ASSERT_TRUE(found.bounded());
    EXPECT_EQ(found.from_event(1), 12 * ms);
    EXPECT_EQ(found.from_event(3), 12 * ms);
    EXPECT_GT(found.rounds, 2u);
}

TEST(EventTimes, say_that_there_is_no_end) {
    // What is late on one processor brings two at once to the other, which makes what goes back later still.
    const std::array circle{
        ChainStep{.resource = cpu1, .rank = 2, .longest_ns = 9 * ms, .period_ns = 20 * ms},
        ChainStep{.resource = cpu2, .rank = 1, .longest_ns = 10 * ms, .after = 0},
        ChainStep{.resource = cpu2, .rank = 2, .longest_ns = 9 * ms, .period_ns = 20 * ms},
        ChainStep{.resource = cpu1, .rank = 1, .longest_ns = 10 * ms, .after = 2},
    };
    const auto found = event_times<4>(circle, with_wire);
    using How = EventTimes<4>::How;
    EXPECT_EQ(found.how, How::no_end);
    EXPECT_EQ(found.rounds, most_chain_rounds);
    EXPECT_EQ(event_times<4>(std::span{circle}.first(2), with_wire).from_event(1), 19 * ms);
}

TEST(EventTimes, say_which_step_makes_no_sense) {
    using How = EventTimes<3>::How;
    const ChainStep good{.resource = cpu1, .rank = 1, .longest_ns = 1 * ms, .period_ns = 10 * ms};
    const auto second = [&](const ChainStep& step) {
        const std::array steps{good, step};
        return event_times<3>(steps, with_wire);
    };
    const auto expect = [&](const ChainStep& step, How how) {
        const auto found = second(step);
        EXPECT_EQ(found.how, how);
        EXPECT_EQ(found.at, 1u);
        EXPECT_FALSE(found.bounded());
    };
    expect({.resource = cpu1, .rank = 1, .longest_ns = 1, .period_ns = ms}, How::equal_ranks);
    expect({.rank = 2, .longest_ns = 1}, How::not_a_step);
    expect({.rank = 2, .longest_ns = 1, .after = 1}, How::not_a_step);
    expect({.rank = 2, .longest_ns = 1, .after = 7}, How::not_a_step);
    expect({.rank = 2, .longest_ns = 1, .shortest_ns = 2, .after = 0}, How::not_a_step);
    expect({.rank = 2, .longest_ns = -1, .shortest_ns = -1, .after = 0}, How::not_a_step);
    expect({.rank = 2, .longest_ns = 1, .period_ns = 5, .jitter_ns = -1}, How::not_a_step);
    expect({.rank = 2, .longest_ns = 1, .period_ns = 5, .blocking_ns = -1}, How::not_a_step);
    expect({.rank = 2, .longest_ns = analysis_max_ns + 1, .period_ns = 5}, How::not_a_step);
    expect({.rank = 2, .longest_ns = 10 * ms, .period_ns = 10 * ms}, How::unbounded);
    expect({.rank = 2, .longest_ns = 10 * ms, .after = 0}, How::unbounded);
    EXPECT_TRUE(second({.resource = cpu2, .rank = 1, .longest_ns = 1, .after = 0}).bounded());
    const std::array many{good, good, good, good};
    EXPECT_EQ(event_times<3>(many, with_wire).how, How::too_many);
    EXPECT_TRUE(event_times<3>({}, with_wire).bounded());
}

TEST(EventTimes, name_the_largest_term_of_a_hop) {
    const std::array steps{
        ChainStep{.resource = cpu1, .rank = 1, .longest_ns = 2 * ms, .period_ns = 5 * ms},
        ChainStep{
            .resource = cpu1, .rank = 2, .longest_ns = 3 * ms, .period_ns = 50 * ms, .blocking_ns = 1 * ms},
        ChainStep{
            .resource = cpu1, .rank = 3, .longest_ns = 1 * ms, .period_ns = 50 * ms, .blocking_ns = 9 * ms},
    };
    const auto found = event_times<3>(steps, with_wire);
    EXPECT_EQ(found.hops[0].largest, TimeTerm::own);
    EXPECT_EQ(found.hops[0].of, no_chain_step);
    EXPECT_EQ(found.hops[1].largest, TimeTerm::others);
    EXPECT_EQ(found.hops[1].of, 0u);
    EXPECT_EQ(found.hops[1].largest_ns, 4 * ms);
    EXPECT_EQ(found.hops[2].largest, TimeTerm::others) << "25 ms hold five of the first";
    EXPECT_EQ(found.hops[2].largest_ns, 10 * ms);
}

} // namespace
} // namespace tappet

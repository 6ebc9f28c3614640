// Method calls that components answer by turns: the running component answers each step of each caller, in
// any activity.
#include "tests/kernel/control/axis.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <gmock/gmock.h>

namespace tappet {
namespace {

/// Process component: it answers with a number that identifies it.
struct Gauge {
    Property<std::int64_t> answer{0};
    std::int64_t starts = 0;
    std::atomic<std::int64_t> asked{0};
    void start(const Cycle&) noexcept TAPPET_REALTIME { ++starts; }
    std::int64_t length() noexcept TAPPET_REALTIME {
        asked.fetch_add(1, std::memory_order_relaxed);
        return answer.get();
    }
    static constexpr auto interface() {
        return facets(method<&Gauge::length>("length", "of what is measured", any_thread),
                      property<&Gauge::answer>("answer", "", "that it gives", range(0, 99)));
    }
};

struct Asker {
    MethodCall<std::int64_t()> length;
    std::int64_t got = -1, steps = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        got = length().value_or(-1);
        ++steps;
    }
    static constexpr auto interface() {
        return facets(calls<&Asker::length>("length", "of what is measured"));
    }
};

// clang-format off
constexpr auto table = machine("axis",
    components(
        component<ChainSwitch>("gauge"), component<Slide>("slide"), component<Encoder>("encoder"), component<Mover>("standing"),
        component<Follower>("position"), component<Limiter>("limiter"),
        component<Gauge>("drawn", set("answer", 1)), component<Gauge>("measured", set("answer", 2)), component<Gauge>("guessed", set("answer", 3)),
        component<Asker>("near"), component<Asker>("far")),
    activities(
        activity("motion", every(1ms), budget(100us), runs("gauge", "slide", "encoder", "standing", "position", "limiter", "drawn", "measured", "guessed", "near")),
        activity("watch",  every(5ms), budget(100us), runs("far"))),
    connections(
        data("slide.place", "encoder.counted"), data("encoder.position", "standing.measured"), data("encoder.position", "position.measured"),
        data("standing.target", "position.target"), data("position.velocity", "limiter.velocity"),
        data("limiter.sent", "position.sent", delayed), data("limiter.sent", "slide.driven", delayed)),
    reactions(
        uses("near.length", "drawn.length"), uses("near.length", "measured.length"), uses("near.length", "guessed.length"),
        uses("far.length",  "drawn.length"), uses("far.length",  "measured.length"), uses("far.length",  "guessed.length")),
    behaviours(),
    control(
        level("axis", sensor("encoder"), generator("standing"), controller("position", tracks("sent")), effector("limiter")),
        process("drawn"), process("measured"), process("guessed"), process("near"), process("far"),
        exclusive("gauge", fallback("drawn", "drawn"), chain("measured", "measured"), chain("guessed", "guessed"))));
// clang-format on

struct Calls : testing::Test, VirtualRig {
    Calls() : VirtualRig{AtRunTime<table, box>::machine()} {
        start();
        run(20ms);
    }
    Gauge& gauge(std::string_view name) { return the<Gauge>(name); }
    Asker& asker(std::string_view name) { return the<Asker>(name); }
    void hand_over_to(std::string_view chain) {
        ScriptText name;
        EXPECT_TRUE(name.assign(chain));
        EXPECT_TRUE(the<ChainSwitch>("gauge").run(name));
    }
    std::int64_t answers() { return gauge("drawn").asked + gauge("measured").asked + gauge("guessed").asked; }
};

TEST_F(Calls, are_answered_by_the_fallback_first) {
    EXPECT_EQ(asker("near").got, 1);
    EXPECT_EQ(asker("far").got, 1);
    EXPECT_EQ(gauge("measured").asked, 0);
}

TEST_F(Calls, are_answered_by_the_running_component_from_the_hand_over_step) {
    std::int64_t wanted = 1;
    for (const auto& [chain, answer] :
         {std::pair{"measured", 2}, {"guessed", 3}, {"drawn", 1}, {"guessed", 3}}) {
        const std::int64_t before = gauge(chain).asked;
        EXPECT_EQ(asker("near").got, wanted);
        hand_over_to(chain);
        EXPECT_TRUE(run(1ms));
        EXPECT_EQ(asker("near").got, answer) << "in the very cycle";
        EXPECT_GT(gauge(chain).asked, before);
        EXPECT_TRUE(run(10ms));
        EXPECT_EQ(asker("far").got, answer) << "of another activity";
        wanted = answer;
    }
    EXPECT_EQ(answers(), asker("near").steps + asker("far").steps) << "each was answered once";
    EXPECT_EQ(gauge("guessed").starts, 2);
}

TEST_F(Calls, go_to_the_fallback_when_the_answering_component_stops) {
    hand_over_to("measured");
    EXPECT_TRUE(run(10ms));
    EXPECT_EQ(asker("far").got, 2);
    change("measured", LifeChange::stop);
    EXPECT_TRUE(run(10ms));
    EXPECT_EQ(asker("near").got, 1);
    EXPECT_EQ(asker("far").got, 1);
    EXPECT_EQ(answers(), asker("near").steps + asker("far").steps);
}

TEST_F(Calls, stop_the_machine_when_no_component_remains_to_answer) {
    change("drawn", LifeChange::stop);
    run(10ms);
    ASSERT_TRUE(instance.stop_asked());
    EXPECT_THAT(std::string{instance.describe_stop().view()},
                testing::HasSubstr("\"drawn\" stopped, could not start"));
}

TEST_F(Calls, return_to_the_fallback_when_their_activity_restarts) {
    hand_over_to("guessed");
    EXPECT_TRUE(run(10ms));
    instance.life().ask_activity(0, LifeChange::restart);
    EXPECT_TRUE(run(10ms));
    EXPECT_EQ(asker("near").got, 1);
    EXPECT_EQ(asker("far").got, 1);
}

} // namespace
} // namespace tappet

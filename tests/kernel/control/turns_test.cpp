// Components that run by turns: one writer in every cycle, a bumpless hand-over within one cycle, and the
// response to a failing part.
#include "tests/kernel/control/axis.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include "kernel/base/random.hpp"

#include <gmock/gmock.h>

namespace tappet {
namespace {

using testing::HasSubstr;

constexpr auto table = axis_machine(control(axis_level, process("watcher"), axis_modes));

struct Rig : VirtualRig {
    explicit Rig(bool measures = true) : VirtualRig{AtRunTime<table, box>::machine()} {
        start([&] { the<Slide>("slide").is_silent = !measures; });
        EXPECT_TRUE(!measures || run(3ms));
    }
    ComponentState state(std::string_view name) {
        return instance.life().state_of(find_component(instance.machine().table, name));
    }

    std::string running() { return std::string{the<ChainSwitch>("mode").chain.last().view()}; }
    std::string hindered() { return std::string{the<ChainSwitch>("mode").hindered.last().view()}; }
    /// Commands like a component and waits for the end.
    CommandState ask(const char* chain) {
        ScriptText name;
        EXPECT_TRUE(name.assign(chain));
        auto& call = the<Watcher>("watcher").run;
        call.reset();
        EXPECT_TRUE(call.send(name));
        EXPECT_TRUE(run(4ms));
        return call.state();
    }
    std::size_t writers(std::string_view one, std::string_view other) {
        return (state(one) == ComponentState::running ? 1u : 0u) +
               (state(other) == ComponentState::running ? 1u : 0u);
    }
    void force(std::string_view input, double to) {
        End end;
        ASSERT_TRUE(resolve(instance.machine().table, input, FacetKind::input, end).empty());
        port = facet_at(instance.machine().table, end).port;
        place = instance.place_of(end);
        port->force(place, true, reinterpret_cast<const std::byte*>(&to));
    }
    /// Whether the input forced last is still forced.
    [[nodiscard]] bool is_forced() const { return *port->places(place, true).forced; }

    const PortOperations* port = nullptr;
    void* place = nullptr;
};

TEST(Turns, start_the_fallback_and_let_the_others_wait) {
    Rig rig;
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_EQ(rig.state("standing"), ComponentState::running);
    EXPECT_EQ(rig.state("position"), ComponentState::running);
    EXPECT_EQ(rig.state("jogging"), ComponentState::stopped);
    EXPECT_EQ(rig.state("gentle"), ComponentState::stopped);
}

/// It measures nothing until the test enables it.
TEST(Turns, begin_only_when_every_input_has_a_valid_value) {
    Rig rig{false};
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_EQ(rig.state("standing"), ComponentState::waiting);
    EXPECT_EQ(rig.state("limiter"), ComponentState::waiting);
    EXPECT_EQ(rig.the<Limiter>("limiter").cycles, 0u);
    EXPECT_FALSE(rig.instance.stop_asked()) << "who waits has not failed";
    rig.the<Slide>("slide").is_silent = false;
    EXPECT_TRUE(rig.run(3ms));
    EXPECT_EQ(rig.state("standing"), ComponentState::running);
    EXPECT_EQ(rig.state("jogging"), ComponentState::stopped);
    EXPECT_GT(rig.the<Limiter>("limiter").cycles, 0u);
}

TEST(Turns, are_requested_by_a_command_that_ends_when_the_chain_runs) {
    Rig rig;
    EXPECT_EQ(rig.ask("jog"), CommandState::done);
    EXPECT_EQ(rig.running(), "jog");
    EXPECT_EQ(rig.state("standing"), ComponentState::stopped);
    EXPECT_EQ(rig.state("jogging"), ComponentState::running);
    EXPECT_EQ(rig.state("position"), ComponentState::running) << "both chains have it: it goes on";
    EXPECT_EQ(rig.ask("jgo"), CommandState::rejected);
    EXPECT_EQ(rig.ask("jog"), CommandState::done) << "it runs already";
    EXPECT_TRUE(rig.run(20ms));
    EXPECT_EQ(rig.the<Watcher>("watcher").changes, 1u);
    EXPECT_EQ(rig.instance.observation().counted(0, 1).what, "jog");
    EXPECT_EQ(rig.instance.observation().counted(0, 1).times, 1u);
}

// At 1000 instants, from any chain to any other, with the axis moving: in every cycle one of the writers
// runs, the set point continues from the axis position, and the velocity jumps by no more than the loop
// itself would change it in one step.
TEST(Turns, keep_one_writer_in_every_cycle_without_a_velocity_jump) {
    Rig rig;
    auto& mode = rig.the<ChainSwitch>("mode");
    auto& sent = rig.the<Limiter>("limiter");
    auto& slide = rig.the<Slide>("slide");
    Random random{7};
    rig.the<Mover>("jogging").speed = 0.3;
    EXPECT_TRUE(rig.run(20ms));
    double before = sent.sent.last();
    constexpr std::array<const char*, 3> chains{"stand", "jog", "softly"};
    double worst = 0.0;
    for (int change = 0; change < 1000; ++change) {
        ScriptText next;
        ASSERT_TRUE(next.assign(chains[random.below(3)]));
        ASSERT_TRUE(mode.run(next));
        const auto cycles = 1 + random.below(40);
        for (std::uint64_t i = 0; i < cycles; ++i) {
            const std::uint64_t steps = sent.cycles;
            ASSERT_TRUE(rig.run(1ms));
            ASSERT_EQ(sent.cycles, steps + 1);
            ASSERT_EQ(rig.writers("standing", "jogging"), 1u);
            ASSERT_EQ(rig.writers("position", "gentle"), 1u);
            worst = std::max(worst, std::abs(sent.sent.last() - before));
            before = sent.sent.last();
        }
    }
    // In one step: kp 20/s times the difference between the ways of set point and slide, each at 0.3 m/s for
    // 1 ms, plus 5 parts of 1000 of the velocity sent before.
    EXPECT_LT(worst, 20.0 * (0.3 + 0.3) * step_s + 0.3 * 5.0 * step_s);
    EXPECT_GT(worst, 1e-4) << "the axis was under way";
    EXPECT_TRUE(std::isfinite(slide.at));
}

TEST(Turns, are_refused_with_the_reason_when_a_component_cannot_start) {
    Rig rig;
    rig.the<Mover>("jogging").is_mute = true; // its start() writes nothing: no reader sees its old value
    EXPECT_EQ(rig.ask("jog"), CommandState::failed);
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_EQ(rig.hindered(), "position.target") << "it runs on, and would read what was written long ago";
    EXPECT_EQ(rig.ask("softly"), CommandState::failed);
    EXPECT_EQ(rig.hindered(), "gentle.target");
    EXPECT_EQ(rig.state("standing"), ComponentState::running);
    EXPECT_EQ(rig.state("jogging"), ComponentState::stopped);
    EXPECT_EQ(rig.state("gentle"), ComponentState::stopped);
    rig.the<Mover>("jogging").is_mute = false;
    EXPECT_EQ(rig.ask("softly"), CommandState::done);
    EXPECT_EQ(rig.hindered(), "");
}

TEST(Turns, leave_all_waiting_when_requested_before_any_measurement) {
    Rig rig{false};
    EXPECT_EQ(rig.ask("softly"), CommandState::failed);
    EXPECT_FALSE(rig.instance.stop_asked());
    rig.the<Slide>("slide").is_silent = false;
    EXPECT_TRUE(rig.run(3ms));
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_EQ(rig.state("position"), ComponentState::running);
}

TEST(Turns, stop_the_machine_when_the_requested_fallback_cannot_start) {
    Rig rig;
    EXPECT_EQ(rig.ask("jog"), CommandState::done);
    rig.the<Mover>("standing").is_mute = true;
    ScriptText stand{"stand"};
    EXPECT_TRUE(rig.the<ChainSwitch>("mode").run(stand));
    rig.run(4ms);
    EXPECT_TRUE(rig.instance.stop_asked()) << "who asks for rest does not get motion";
}

TEST(Turns, fall_back_when_a_part_of_the_chain_stops) {
    Rig rig;
    EXPECT_EQ(rig.ask("softly"), CommandState::done);
    rig.change("jogging", LifeChange::stop);
    EXPECT_TRUE(rig.run(2ms));
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_EQ(rig.state("standing"), ComponentState::running);
    EXPECT_TRUE(rig.run(10ms));
    EXPECT_EQ(rig.the<Watcher>("watcher").fallbacks, 1u);
    EXPECT_FALSE(rig.instance.stop_asked());
    EXPECT_EQ(rig.ask("softly"), CommandState::done) << "who was stopped starts with its chain";
}

TEST(Turns, stop_the_machine_when_the_fallback_itself_fails) {
    Rig rig;
    rig.change("standing", LifeChange::stop);
    rig.run(5ms);
    ASSERT_TRUE(rig.instance.stop_asked());
    EXPECT_THAT(std::string{rig.instance.describe_stop().view()},
                HasSubstr("\"standing\" stopped, could not start"));
}

TEST(Turns, stop_the_machine_when_a_permanent_part_stops) {
    Rig rig;
    rig.change("encoder", LifeChange::stop);
    rig.run(5ms);
    EXPECT_TRUE(rig.instance.stop_asked());
}

TEST(Turns, end_and_begin_with_the_component_that_hands_over) {
    Rig rig;
    EXPECT_EQ(rig.ask("softly"), CommandState::done);
    rig.change("mode", LifeChange::stop);
    EXPECT_TRUE(rig.run(3ms));
    EXPECT_EQ(rig.state("jogging"), ComponentState::stopped);
    EXPECT_EQ(rig.state("gentle"), ComponentState::stopped);
    EXPECT_EQ(rig.the<Limiter>("limiter").sent.last(), 0.0);
    EXPECT_EQ(rig.ask("stand"), CommandState::rejected);
    rig.change("mode", LifeChange::start);
    EXPECT_TRUE(rig.run(3ms));
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_EQ(rig.state("standing"), ComponentState::running);
    EXPECT_EQ(rig.state("position"), ComponentState::running);
    EXPECT_EQ(rig.ask("softly"), CommandState::done);
}

/// Holds whichever row of the input is last in the table.
TEST(Turns, keep_a_force_until_the_current_writer_stops) {
    Rig rig;
    EXPECT_TRUE(rig.run(5ms));
    ASSERT_EQ(rig.ask("jog"), CommandState::done);
    rig.force("limiter.velocity", 0.3);
    rig.change("gentle", LifeChange::stop); // it is stopped and writes nothing
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_TRUE(rig.is_forced());
    ASSERT_EQ(rig.ask("softly"), CommandState::done);
    EXPECT_TRUE(rig.is_forced());
    rig.change("position", LifeChange::stop); // it wrote the input before
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_TRUE(rig.is_forced());
    rig.change("gentle", LifeChange::stop);
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_FALSE(rig.is_forced());
}

TEST(Turns, are_refused_despite_a_force_on_an_unwritten_input_and_keep_it) {
    Rig rig;
    EXPECT_TRUE(rig.run(5ms));
    rig.force("position.target", 0.3);
    rig.the<Mover>("jogging").is_mute = true;
    EXPECT_NE(rig.ask("jog"), CommandState::done);
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_TRUE(rig.is_forced());
}

TEST(Turns, cannot_be_started_component_by_component) {
    Rig rig;
    const std::size_t jogging = find_component(rig.instance.machine().table, "jogging");
    const LifeTicket ticket = rig.change("jogging", LifeChange::start);
    EXPECT_TRUE(rig.run(3ms));
    const LifeAnswer answer = rig.instance.life().answer_of_component(jogging, ticket);
    EXPECT_EQ(answer.refusal, LifeRefusal::waits_for_its_turn);
    EXPECT_THAT(std::string{rig.instance.life().describe(0, answer).view()},
                HasSubstr("it alternates with other components of activity \"motion\""));
}

TEST(Turns, restart_with_their_activity) {
    Rig rig;
    EXPECT_EQ(rig.ask("softly"), CommandState::done);
    rig.instance.life().ask_activity(0, LifeChange::restart);
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_EQ(rig.state("gentle"), ComponentState::stopped);
    EXPECT_EQ(rig.state("standing"), ComponentState::running);
}

// ---- forced values where several components write by turns

struct ForcedTurn : testing::Test {
    Rig rig;

    void SetUp() override {
        EXPECT_TRUE(rig.run(5ms));
        rig.force("limiter.velocity", 1.5);
        EXPECT_TRUE(rig.run(3ms));
        EXPECT_EQ(rig.the<Limiter>("limiter").sent.last(), 1.5);
    }

    void expect_it_ends() {
        EXPECT_TRUE(rig.run(20ms));
        EXPECT_FALSE(rig.is_forced());
        EXPECT_NE(rig.the<Limiter>("limiter").sent.last(), 1.5);
    }
};

TEST_F(ForcedTurn, ends_when_its_writer_stops) {
    rig.change("position", LifeChange::restart);
    expect_it_ends();
}

TEST_F(ForcedTurn, ends_when_its_writer_stops_before_another_turn_of_that_writer) {
    rig.change("position", LifeChange::restart);
    ScriptText jog{"jog"};
    EXPECT_TRUE(rig.the<ChainSwitch>("mode").run(jog));
    expect_it_ends();
    EXPECT_EQ(rig.running(), "jog");
}

TEST_F(ForcedTurn, ends_when_the_switch_restarts) {
    rig.change("mode", LifeChange::restart);
    expect_it_ends();
}

TEST_F(ForcedTurn, ends_when_the_switch_restarts_in_another_turn) {
    ASSERT_EQ(rig.ask("jog"), CommandState::done);
    EXPECT_TRUE(rig.is_forced()) << "it is the next writer's now";
    rig.change("mode", LifeChange::restart);
    expect_it_ends();
}

/// Only the chain before it writes the input again.
struct ForcedAfterFallBack : ForcedTurn {
    void SetUp() override {
        ForcedTurn::SetUp();
        ASSERT_EQ(rig.ask("softly"), CommandState::done);
        rig.change("gentle", LifeChange::stop);
        EXPECT_TRUE(rig.run(5ms));
        ASSERT_FALSE(rig.is_forced());
        rig.force("limiter.velocity", 1.5);
        EXPECT_TRUE(rig.run(5ms));
    }
};

TEST_F(ForcedAfterFallBack, ends_when_the_current_writer_stops) {
    rig.change("position", LifeChange::restart);
    expect_it_ends();
}

TEST_F(ForcedAfterFallBack, lasts_when_a_component_of_another_turn_stops) {
    rig.change("gentle", LifeChange::stop);
    EXPECT_TRUE(rig.run(20ms));
    EXPECT_TRUE(rig.is_forced());
}

} // namespace
} // namespace tappet

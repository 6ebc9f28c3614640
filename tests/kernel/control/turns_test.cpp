// Components that run by turns: one writer in every cycle, a hand-over within one cycle and without a bump,
// and what happens when a part fails.
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
    /// Asks as a component would, and waits for the end.
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
    /// What was forced last.
    [[nodiscard]] bool is_forced() const { return *port->places(place, true).forced; }

    const PortOperations* port = nullptr;
    void* place = nullptr;
};

TEST(Turns, begin_with_the_fallback_and_the_others_wait) {
    Rig rig;
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_EQ(rig.state("standing"), ComponentState::running);
    EXPECT_EQ(rig.state("position"), ComponentState::running);
    EXPECT_EQ(rig.state("jogging"), ComponentState::stopped);
    EXPECT_EQ(rig.state("gentle"), ComponentState::stopped);
}

/// It has measured nothing until it is told to.
TEST(Turns, begin_when_every_input_has_a_valid_value_and_not_with_a_zero) {
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

TEST(Turns, are_asked_for_by_a_command_that_is_done_when_the_chain_runs) {
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

// At 1000 instants, from any chain to any other, with the axis under way: in every cycle one of the writers
// runs, the set point goes on from where the axis is, and the velocity does not jump by more than the loop
// itself would move it in one step.
TEST(Turns, leave_one_writer_in_every_cycle_and_no_jump_of_the_velocity) {
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
    // In one step: kp 20/s times the way of the set point against that of the slide, each at 0.3 m/s for 1
    // ms, and of what was sent before 5 parts of 1000.
    EXPECT_LT(worst, 20.0 * (0.3 + 0.3) * step_s + 0.3 * 5.0 * step_s);
    EXPECT_GT(worst, 1e-4) << "the axis was under way";
    EXPECT_TRUE(std::isfinite(slide.at));
}

TEST(Turns, do_not_happen_when_one_cannot_start_and_say_what_hinders) {
    Rig rig;
    rig.the<Mover>("jogging").is_mute =
        true; // its start() writes nothing: nobody reads what it wrote long ago
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

TEST(Turns, asked_for_before_anything_was_measured_leave_all_waiting) {
    Rig rig{false};
    EXPECT_EQ(rig.ask("softly"), CommandState::failed);
    EXPECT_FALSE(rig.instance.stop_asked());
    rig.the<Slide>("slide").is_silent = false;
    EXPECT_TRUE(rig.run(3ms));
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_EQ(rig.state("position"), ComponentState::running);
}

TEST(Turns, stop_the_machine_when_the_fallback_is_asked_for_and_cannot_start) {
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

TEST(Turns, stop_the_machine_when_a_part_stops_that_always_runs) {
    Rig rig;
    rig.change("encoder", LifeChange::stop);
    rig.run(5ms);
    EXPECT_TRUE(rig.instance.stop_asked());
}

TEST(Turns, end_with_the_component_that_hands_over_and_begin_with_it) {
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

/// Whichever row of the input comes last in the table.
TEST(Turns, leave_what_is_forced_until_the_one_stops_that_writes_it_then) {
    Rig rig;
    EXPECT_TRUE(rig.run(5ms));
    ASSERT_EQ(rig.ask("jog"), CommandState::done);
    rig.force("limiter.velocity", 0.3);
    rig.change("gentle", LifeChange::stop); // which stands, and writes nothing
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_TRUE(rig.is_forced());
    ASSERT_EQ(rig.ask("softly"), CommandState::done);
    EXPECT_TRUE(rig.is_forced());
    rig.change("position", LifeChange::stop); // which wrote it before
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_TRUE(rig.is_forced());
    rig.change("gentle", LifeChange::stop);
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_FALSE(rig.is_forced());
}

TEST(Turns, are_refused_though_a_force_stands_for_what_nobody_wrote_and_leave_it) {
    Rig rig;
    EXPECT_TRUE(rig.run(5ms));
    rig.force("position.target", 0.3);
    rig.the<Mover>("jogging").is_mute = true;
    EXPECT_NE(rig.ask("jog"), CommandState::done);
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_TRUE(rig.is_forced());
}

TEST(Turns, are_not_taken_alone) {
    Rig rig;
    const std::size_t jogging = find_component(rig.instance.machine().table, "jogging");
    const LifeTicket ticket = rig.change("jogging", LifeChange::start);
    EXPECT_TRUE(rig.run(3ms));
    const LifeAnswer answer = rig.instance.life().answer_of_component(jogging, ticket);
    EXPECT_EQ(answer.refusal, LifeRefusal::waits_for_its_turn);
    EXPECT_THAT(std::string{rig.instance.life().describe(0, answer).view()},
                HasSubstr("it runs by turns with others of activity \"motion\""));
}

TEST(Turns, begin_anew_with_their_activity) {
    Rig rig;
    EXPECT_EQ(rig.ask("softly"), CommandState::done);
    rig.instance.life().ask_activity(0, LifeChange::restart);
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_EQ(rig.running(), "stand");
    EXPECT_EQ(rig.state("gentle"), ComponentState::stopped);
    EXPECT_EQ(rig.state("standing"), ComponentState::running);
}

// ---- what is forced where several write by turns

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

TEST_F(ForcedTurn, ends_with_a_stop_of_its_writer) {
    rig.change("position", LifeChange::restart);
    expect_it_ends();
}

TEST_F(ForcedTurn, ends_with_a_stop_of_its_writer_before_a_turn_that_it_writes_too) {
    rig.change("position", LifeChange::restart);
    ScriptText jog{"jog"};
    EXPECT_TRUE(rig.the<ChainSwitch>("mode").run(jog));
    expect_it_ends();
    EXPECT_EQ(rig.running(), "jog");
}

TEST_F(ForcedTurn, ends_with_a_restart_of_the_switch) {
    rig.change("mode", LifeChange::restart);
    expect_it_ends();
}

TEST_F(ForcedTurn, ends_with_a_restart_of_the_switch_in_another_turn) {
    ASSERT_EQ(rig.ask("jog"), CommandState::done);
    EXPECT_TRUE(rig.is_forced()) << "it is the next writer's now";
    rig.change("mode", LifeChange::restart);
    expect_it_ends();
}

/// The chain before it writes the input again, and nobody else.
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

TEST_F(ForcedAfterFallBack, ends_with_a_stop_of_who_writes_the_input_now) {
    rig.change("position", LifeChange::restart);
    expect_it_ends();
}

TEST_F(ForcedAfterFallBack, lasts_when_somebody_stops_whose_turn_it_is_not) {
    rig.change("gentle", LifeChange::stop);
    EXPECT_TRUE(rig.run(20ms));
    EXPECT_TRUE(rig.is_forced());
}

} // namespace
} // namespace tappet

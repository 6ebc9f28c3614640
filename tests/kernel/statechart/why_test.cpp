// Why a state machine is not in a state: the predicted answer of a transition, the reported refusals, and the
// ways that lead to a state.
#include "kernel/statechart/native.hpp"
#include "kernel/statechart/ways.hpp"

#include <gtest/gtest.h>

namespace tappet {
namespace {

// It starts when it is warm and closed.
struct Oven {
    bool is_warm = false, is_closed = false;
    [[nodiscard]] bool warm() const noexcept TAPPET_REALTIME { return is_warm; }
    [[nodiscard]] bool closed() const noexcept TAPPET_REALTIME { return is_closed; }
    [[nodiscard]] std::string_view lid() const noexcept TAPPET_REALTIME { return "the lid is open"; }
};
constexpr auto oven = state_machine<Oven>(
    "oven",
    states(state("cold", initial),
           state("runs", precondition<&Oven::closed>.because<&Oven::lid>("it would burn somebody")),
           state("safe", final)),
    transitions(transition("cold", "runs", on("start"), guard<&Oven::warm>.because("the oven is cold")),
                transition("cold", "safe", after(10s)), transition("runs", "cold", guard<&Oven::warm>)));
static_assert(check(oven.view()).empty());

TEST(Look, predicts_the_answer_to_a_transition_without_executing_it) {
    using Look = StateMachineExecution::Look;
    for (const bool compiled : {false, true}) {
        Oven component;
        StateMachineExecution machine;
        StateMachineBinding binding{.machine = resolved<oven>.view(), .component = &component};
        if (compiled) binding.fast = native_machine<oven>;
        ASSERT_TRUE(machine.bind(binding));
        Time now = at_ns(1000);
        EXPECT_EQ(machine.look(0, now).answer, Look::Answer::elsewhere) << "it is not active";
        machine.start(now);
        EXPECT_EQ(machine.look(0, now).answer, Look::Answer::guard);
        EXPECT_EQ(machine.look(1, now += 4s).answer, Look::Answer::too_early);
        EXPECT_EQ(machine.look(1, now).left, 6s);
        EXPECT_EQ(machine.look(2, now).answer, Look::Answer::elsewhere);
        EXPECT_EQ(machine.look(3, now).answer, Look::Answer::elsewhere) << "there is no such transition";

        EXPECT_EQ(machine.refusals().number, 0u);
        EXPECT_EQ(machine.dispatch(0, now), StateOutcome::ignored);
        EXPECT_EQ(machine.refusals(), (StateMachineExecution::News{1, 0})) << "its guard has a reason";
        component.is_warm = true;
        const Look refused = machine.look(0, now);
        EXPECT_EQ(refused.answer, Look::Answer::precondition);
        EXPECT_EQ(refused.state, 1u);
        EXPECT_EQ(refused.detail, "the lid is open");
        EXPECT_EQ(machine.dispatch(0, now), StateOutcome::ignored);
        EXPECT_EQ(machine.refusals().number, 1u) << "this time the guard did not refuse it";
        component.is_closed = true;
        EXPECT_EQ(machine.look(0, now).answer, Look::Answer::open);
        EXPECT_EQ(machine.active(), 0u);
        EXPECT_EQ(machine.dispatch(0, now), StateOutcome::taken);
        EXPECT_EQ(machine.refusals().number, 1u);
    }
}

// idle | hall { door { shut open } stage } | safe
constexpr auto hall = state_machine<Oven>(
    "hall",
    states(state("idle", initial), state("hall"), state("door", in("hall"), initial),
           state("shut", in("door"), initial), state("open", in("door")), state("stage", in("hall")),
           state("cellar"), state("safe", final)),
    transitions(transition("idle", "hall", on("enter")), transition("shut", "open", on("push")),
                transition("shut", "cellar", on("fall")), transition("hall", "idle", on("leave")),
                transition("open", "stage", on("walk")),
                transition("cellar", "hall", deep_history, on("climb"))));
static_assert(check(hall.view()).empty());

TEST(Ways, connect_leaves_also_across_composite_states) {
    constexpr ResolvedView machine = resolved<hall>.view();
    const auto number = [&](std::string_view name) { return find_state(machine.table, name); };
    const Ways ways{machine, number("stage")};
    EXPECT_EQ(ways.away(number("stage")), 0);
    EXPECT_EQ(ways.away(number("open")), 1);
    EXPECT_EQ(ways.away(number("idle")), 3) << "\"hall\" enters \"shut\"";
    EXPECT_EQ(ways.next(number("idle")), number("shut"));
    EXPECT_EQ(ways.next(number("shut")), number("open")) << "not the longer way through the cellar";
    EXPECT_EQ(ways.away(number("cellar")), 1) << "by history it may come to the stage at once";
    EXPECT_TRUE(ways.leads_nearer(1, number("shut")));
    EXPECT_TRUE(ways.leads_nearer(2, number("shut"))) << "by history";
    EXPECT_FALSE(ways.leads_nearer(3, number("shut"))) << "\"leave\" leads away";
    const Ways to_hall{machine, number("hall")};
    EXPECT_EQ(to_hall.away(number("stage")), 0) << "a state inside is there";
    EXPECT_EQ(to_hall.away(number("idle")), 1);
    const Ways nowhere{machine, number("safe")};
    EXPECT_EQ(nowhere.away(number("idle")), Ways::none);
    EXPECT_EQ(nowhere.next(number("idle")), no_state);
}

} // namespace
} // namespace tappet

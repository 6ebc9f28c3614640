// Programs spelled in C++ (thesis fig. 5.2): a table of nodes and arcs with member functions, what it
// executes, and what its check refuses.
#include "kernel/program/check_rows.hpp"
#include "kernel/program/execution.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using namespace tappet;
using testing::HasSubstr;

struct Axis {
    int released = 0;
    int crept = 0;
    int braked = 0;
    bool stuck = false;
    void release_brake() noexcept TAPPET_REALTIME { ++released; }
    bool creep() noexcept TAPPET_REALTIME {
        ++crept;
        return !stuck;
    }
    void apply_brake() noexcept TAPPET_REALTIME { ++braked; }
    [[nodiscard]] bool at_switch() const noexcept TAPPET_REALTIME { return crept == 3; }
};
struct Other {
    void act() noexcept TAPPET_REALTIME {}
    [[nodiscard]] bool holds() const noexcept TAPPET_REALTIME { return true; }
};

// clang-format off
constexpr auto homing = program<Axis>("homing",
    graph(node<&Axis::release_brake>("release"),
          node<&Axis::creep>("creep", repeated, fails_to("brake")),
          node<&Axis::apply_brake>("brake")),
    arcs(arc("creep", "brake", timeout(5ms)),
         arc("release", "creep"),
         arc<&Axis::at_switch>("creep", program_end),
         arc("brake", program_end)));
// clang-format on
static_assert(check(homing).empty());
constexpr ProgramTables homing_tables = homing.tables();

struct Homing {
    Axis axis{};
    alignas(data_alignment) std::array<std::byte, homing_tables.layout.size> data{};
    ProgramExecution execution{};
    Homing() {
        ProgramContext context;
        context.component = &axis;
        context.data = data.data();
        execution.bind(interpreted(homing_tables), context, homing_tables.image);
        execution.start();
    }
};

TEST(A_program_in_C_plus_plus, runs_member_functions_along_its_arcs) {
    Homing homing_of;
    for (int step = 0; step < 3; ++step) {
        EXPECT_EQ(homing_of.execution.status(), ProgramStatus::running);
        homing_of.execution.step(at_ns(step));
    }
    EXPECT_EQ(homing_of.execution.status(), ProgramStatus::stopped);
    EXPECT_EQ(homing_of.axis.released, 1);
    EXPECT_EQ(homing_of.axis.crept, 3);
    EXPECT_EQ(homing_of.axis.braked, 0);
}

TEST(A_program_in_C_plus_plus, takes_the_arc_of_a_time_out) {
    Homing homing_of;
    homing_of.execution.step(at_ns(0));
    EXPECT_EQ(homing_of.execution.wakes(), at_ns(5'000'000));
    homing_of.execution.step(at_ns(5'000'000));
    EXPECT_EQ(homing_of.execution.status(), ProgramStatus::stopped);
    EXPECT_EQ(homing_of.axis.braked, 1);
}

TEST(A_program_in_C_plus_plus, goes_where_its_node_says_when_its_action_answers_false) {
    Homing homing_of;
    homing_of.axis.stuck = true;
    homing_of.execution.step(at_ns(0));
    EXPECT_EQ(homing_of.execution.status(), ProgramStatus::stopped);
    EXPECT_EQ(homing_of.axis.crept, 1);
    EXPECT_EQ(homing_of.axis.braked, 1);
}

TEST(The_check_of_a_program, refuses_what_cannot_be_meant) {
    const auto fault = [](const auto& table) { return std::string{check(table).view()}; };
    const auto good = arcs(arc("go", program_end));
    EXPECT_EQ(fault(program<Axis>("p", graph(node("go")), good)), "");
    EXPECT_THAT(
        fault(program<Axis>("p", graph(node("release"), node("creep")),
                            arcs(arc("release", "crep"), arc("creep", program_end)))),
        HasSubstr("program \"p\": arc 1 (\"release\" to \"crep\"): there is no node \"crep\"; did you "
                  "mean \"creep\"?"));
    EXPECT_THAT(fault(program<Axis>("p", graph(node("go")), arcs(arc("gone", program_end)))),
                HasSubstr("there is no node \"gone\"; did you mean \"go\"?"));
    EXPECT_THAT(fault(program<Axis>("p", graph(node("go", fails_to("safe"))), good)),
                HasSubstr("node \"go\": there is no node \"safe\""));
    EXPECT_THAT(fault(program<Axis>("p", graph(node("go"), node("go")), good)),
                HasSubstr("two nodes \"go\""));
    EXPECT_THAT(fault(program<Axis>("p", graph(node("")), good)), HasSubstr("node 1 has no name"));
    EXPECT_THAT(fault(program<Axis>("p", graph(node("go"), node("left")),
                                    arcs(arc("go", program_end), arc("left", program_end)))),
                HasSubstr("no arc leads to node \"left\""));
    EXPECT_THAT(fault(program<Axis>("p", graph(node("go"), node("last")), arcs(arc("go", "last")))),
                HasSubstr("no arc leads out of node \"last\""));
    EXPECT_THAT(fault(program<Axis>("p", graph(node("go")), arcs(arc("go", "go"), arc("go", program_end)))),
                HasSubstr("arc 1 of it is always open"));
    EXPECT_THAT(fault(program<Axis>("p", graph(node<&Other::act>("go")), good)), HasSubstr("function of"));
    EXPECT_THAT(fault(program<Axis>("p", graph(node("go")), arcs(arc<&Other::holds>("go", program_end)))),
                HasSubstr("its condition is a function of"));
    EXPECT_THAT(fault(program<Axis>("p", graph(node("go")), arcs(arc("go", program_end, timeout(-1ms))))),
                HasSubstr("time-out is negative"));
}

} // namespace

// State machines with rows that name missing programs are refused before execution (thesis 5.2.1).
#include "kernel/statechart/check_references.hpp"

#include <gtest/gtest.h>

namespace {

using namespace tappet;

struct Spoilt {
    ProgramRow program{"p", end_node, end_node, false};
    ConditionRow condition{};
    Instruction instruction{};
    ProgramTables programs{{&instruction, 1}, {&condition, 1}, {}, {}, {&program, 1}, {}, {}, {},
                           {0, 0, 32, 48}};
    StateRow state{.name = "s",
                   .precondition = ConditionRef{ConditionIndex{0}},
                   .entry = ProgramRef{ProgramIndex{0}},
                   .exit = ProgramRef{ProgramIndex{0}},
                   .run = ProgramRef{ProgramIndex{0}},
                   .handle = ProgramRef{ProgramIndex{0}}};
    TransitionRow transition{.from = "s",
                             .to = "s",
                             .guard = ConditionRef{ConditionIndex{0}},
                             .then = ProgramRef{ProgramIndex{0}},
                             .otherwise = ProgramRef{ProgramIndex{0}},
                             .captures = 1};
    CaptureRow capture{0, 8, 0, 0, 1};
    StateMachineTable table{"m", {&state, 1}, {&transition, 1}, nullptr, &programs, {&capture, 1}};
};

TEST(A_state_machine, passes_when_its_programs_exist) {
    EXPECT_EQ(check_references(Spoilt{}.table).view(), "");
}

TEST(A_state_machine, is_refused_when_a_row_names_a_missing_item) {
    using Spoil = void (*)(Spoilt&);
    const Spoil spoils[] = {
        [](Spoilt& s) { s.state.precondition.condition = 1; },
        [](Spoilt& s) { s.state.entry.program = 1; },
        [](Spoilt& s) { s.state.exit.program = 1; },
        [](Spoilt& s) { s.state.run.program = 1; },
        [](Spoilt& s) { s.state.handle.program = 1; },
        [](Spoilt& s) { s.transition.guard.condition = 1; },
        [](Spoilt& s) { s.transition.then.program = 1; },
        [](Spoilt& s) { s.transition.otherwise.program = 1; },
        [](Spoilt& s) { s.transition.captures = 2; },
        [](Spoilt& s) { s.transition.first_capture = 1; },
        [](Spoilt& s) { s.capture.raw = 48; },
        [](Spoilt& s) { s.capture.count = 2; },
        [](Spoilt& s) { s.table.programs = nullptr; },
    };
    for (std::size_t i = 0; i < std::size(spoils); ++i) {
        Spoilt spoilt;
        spoils[i](spoilt);
        EXPECT_FALSE(check_references(spoilt.table).empty()) << "spoil " << i;
    }
}

} // namespace

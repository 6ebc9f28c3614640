// Scripts: the sentences of their compiler. It is one piece of code, which runs while the firmware is
// compiled or on the target.
#include "kernel/script/load.hpp"
#include "tests/diagnostics/script_case.hpp"

#include <memory>
#include <ostream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace {

using namespace tappet;

struct ScriptFault {
    std::string_view name;
    std::string_view text;
    std::string_view sentence;

    friend std::ostream& operator<<(std::ostream& out, const ScriptFault& row) { return out << row.name; }
};

class ScriptRefusal : public testing::TestWithParam<ScriptFault> {};

TEST_P(ScriptRefusal, is_the_sentence) {
    const auto rows = std::make_unique<ScriptBuffer<script_sizes_for(64, 1024, 1)>>();
    const ScriptOutcome outcome =
        compile_loaded(GetParam().text, "axis.osd", axis_reach.view(), rows->room());
    EXPECT_EQ(outcome.fault.view(), GetParam().sentence);
}

constexpr ScriptFault script_faults[] = {
    {"script_operation_unknown", R"(
program p {
    do axis.hoem(1);
}
)",
     R"(axis.osd:3:13: "axis" has no "hoem"; did you mean "home"?)"},
    {"script_method_that_blocks", R"(
program p {
    do axis.survey();
}
)",
     R"(axis.osd:3:13: "survey" of "axis" may block, and a script's statements do not; make it a command)"},
    {"script_initial_missing", R"(
StateMachine M {
    state A { transition mark select Z }
    final state Z { }
}
RootStateMachine M m
)",
     R"(axis.osd:2:14: state machine "M": no top state is initial; mark the one to start in)"},
    {"script_state_unreachable", R"(
StateMachine M {
    initial state A { transition mark select Z }
    state B { transition mark select Z }
    final state Z { }
}
RootStateMachine M m
)",
     R"(axis.osd:4:5: state machine "M": state "B" is never entered; lead a transition to it, make it initial, or drop it)"},
    {"script_state_without_a_way_out", R"(
StateMachine M {
    initial state A { transition mark select B }
    state B { run { do home(1); } }
    final state Z { }
}
RootStateMachine M m
)",
     R"(axis.osd:4:5: state machine "M": state "B" has no way out; give it a transition, or mark it final)"},
};
INSTANTIATE_TEST_SUITE_P(scripts, ScriptRefusal, testing::ValuesIn(script_faults),
                         [](const auto& row) { return std::string{row.param.name}; });

} // namespace

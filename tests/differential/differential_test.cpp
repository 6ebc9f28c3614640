// Ten thousand random scripts, loaded, on random days: the compiled tables and a second interpreter that
// walks the text's own tree agree in each step: states, variables, ports, properties, and the calls of the
// components in their order (thesis 5.1, 5.2). TAPPET_SEED chooses other scripts.
#include "tests/differential/generator.hpp"
#include "tests/differential/random_day.hpp"

#include "kernel/script/compile.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <memory>

namespace tappet {
namespace {

constexpr ScriptSizes room_sizes = script_sizes_for(2000, 16000, 3);

std::uint64_t seed() {
    const char* const given = std::getenv("TAPPET_SEED");
    return given == nullptr ? 1 : std::strtoull(given, nullptr, 10);
}

std::string numbered(const std::string& text) {
    std::string made;
    int line = 1;
    for (std::size_t at = 0; at < text.size(); ++line) {
        const std::size_t end = text.find('\n', at);
        made += std::to_string(line) + "\t" + text.substr(at, end - at) + "\n";
        at = end + 1;
    }
    return made;
}

struct Loaded {
    std::unique_ptr<ScriptBuffer<room_sizes>> rows = std::make_unique<ScriptBuffer<room_sizes>>();

    ScriptOutcome compile(const std::string& text) {
        Reach reach;
        reach.components = UnitBench::reach();
        reach.statements_per_step = 100'000;
        return compile_into(text, "m.osd", reach, rows->room());
    }
};

void compare_loaded(std::uint64_t first, std::uint64_t count, const GeneratorOptions& options) {
    Loaded loaded;
    for (std::uint64_t n = first; n < first + count; ++n) {
        const std::string text = Generator{n, options}.script();
        const ScriptOutcome outcome = loaded.compile(text);
        ASSERT_TRUE(outcome.good()) << "seed " << n << ": " << outcome.fault.view() << "\n" << numbered(text);
        RandomDay day{n, text, outcome.unit};
        const std::string difference = day.run(60);
        ASSERT_TRUE(difference.empty()) << "seed " << n << "\n" << difference << numbered(text);
    }
}

TEST(A_loaded_program, does_what_its_text_says_step_by_step) {
    compare_loaded(seed() * 1'000'000, 3500, {.machine = false});
}

TEST(A_loaded_state_machine, does_what_its_text_says_step_by_step) {
    compare_loaded(seed() * 2'000'000, 2000, {.states = 4, .nested = false, .children = false});
}

TEST(A_loaded_state_machine, with_composite_states_regions_and_history_does_what_its_text_says) {
    compare_loaded(seed() * 3'000'000, 2500, {.states = 9, .nested = true, .children = false});
}

TEST(A_loaded_state_machine, with_a_child_does_what_its_text_says) {
    compare_loaded(seed() * 4'000'000, 2000, {.states = 5});
}

/// Programs that may run at the same time, all in the same function: the run programs of two regions, an
/// internal transition, an exit.
constexpr std::string_view shared_function = R"(StateMachine Machine {
    param int goal;
    param double speed;
    var int a = 1;
    var int b = 2;
    function helper(int n) {
        var int twice = n + n;
        do arm.sum(n, twice);
        yield;
        set a = twice - n;
        set b = mate.note(n);
        do note(n * 100 + twice);
    }
    initial state Both {
        region east {
            initial state East {
                run { set goal = (goal + 1) % 50; do helper(goal); }
                handle { do helper(30 + a % 7); }
                transition tick() { do helper(20 + goal % 7); }
                transition mate.tick() { do helper(a % 9); } select East
            }
        }
        region west {
            initial state West {
                run { do helper(10 + goal % 10); }
                exit { do helper(40 + b % 5); }
                transitions { after 30ms { do helper(50 + a % 5); } select West }
            }
        }
        transition mate.switched select Safe
    }
    final state Safe { }
}
RootStateMachine Machine m(3, 2.5)
)";

TEST(A_loaded_state_machine, separates_programs_that_share_a_function) {
    const std::string text{shared_function};
    Loaded loaded;
    const ScriptOutcome outcome = loaded.compile(text);
    ASSERT_TRUE(outcome.good()) << outcome.fault.view();
    for (std::uint64_t n = seed() * 5'000'000; n < seed() * 5'000'000 + 60; ++n) {
        RandomDay day{n, text, outcome.unit};
        const std::string difference = day.run(60);
        ASSERT_TRUE(difference.empty()) << "seed " << n << "\n" << difference << numbered(text);
    }
}

/// Kinds of nodes, arcs and transitions, each counted where the second interpreter executes it.
constexpr std::string_view kinds[] = {"var",
                                      "set",
                                      "if",
                                      "if not",
                                      "while",
                                      "for",
                                      "break",
                                      "return",
                                      "yield",
                                      "wait for time",
                                      "wait for a condition",
                                      "try",
                                      "failure caught",
                                      "time-out",
                                      "method",
                                      "function",
                                      "own command",
                                      "program commanded",
                                      "program rejected",
                                      "program stopped",
                                      "result of a program",
                                      "peer's command",
                                      "command rejected",
                                      "command failed",
                                      "command still on its way",
                                      "a step ends in a program",
                                      "statements left over",
                                      "condition in a single step",
                                      "event in a single step",
                                      "child in error: so is its parent",
                                      "function in an expression",
                                      "return of a value",
                                      "record put together",
                                      "field of a record",
                                      "machine in error",
                                      "guard fails",
                                      "argument captured",
                                      "precondition",
                                      "precondition refuses",
                                      "condition transition",
                                      "timed transition",
                                      "time-out of a run program",
                                      "event transition",
                                      "else branch",
                                      "internal transition",
                                      "transition to itself",
                                      "transition to a state around",
                                      "transition into a state inside",
                                      "transition beside other regions",
                                      "one event in several regions",
                                      "composite entered",
                                      "regions entered",
                                      "history",
                                      "deep history",
                                      "a transition takes several steps",
                                      "as many transitions in a step as there may be",
                                      "entered again in the step in which it ran",
                                      "event refused",
                                      "handle of a refused event",
                                      "handle in a round",
                                      "event deferred",
                                      "event deferred by a transition",
                                      "event lost",
                                      "reactive mode",
                                      "condition transition by request",
                                      "run once by request",
                                      "final state by request",
                                      "final state out of an error",
                                      "request while an exit waits",
                                      "request while a transition waits",
                                      "reset",
                                      "paused",
                                      "deactivated",
                                      "second deactivation",
                                      "child: activate",
                                      "child: start",
                                      "child: stop",
                                      "child: pause",
                                      "child: reset",
                                      "child: requestState",
                                      "child: deactivate"};

TEST(The_scripts_together, contain_every_kind_of_node_arc_and_transition) {
    const auto& covered = reference::ProgramRun::covered();
    if (covered.empty()) GTEST_SKIP() << "counts what the tests before it did";
    for (const std::string_view kind : kinds) {
        const auto found = covered.find(std::string{kind});
        std::cout << (found == covered.end() ? 0 : found->second) << "\t" << kind << "\n";
        EXPECT_NE(found, covered.end()) << "no script had: " << kind;
    }
}

} // namespace
} // namespace tappet

// The same text gives the same rows in a constant expression and at run time, and the same fault
// (thesis 5.1.4).
#include "tests/kernel/script/fixture.hpp"

#include "kernel/script/compiled.hpp"

#include <gmock/gmock.h>

namespace {

using namespace script_test;

inline constexpr auto peers_of_own =
    script_reach(reachable<Cell>("own"), reachable<Cell>("robot"), reachable<Cell>("far", false));

// "number" is declared after the states that use it.
inline constexpr ScriptSource cycle{"cycle.osd", R"(
StateMachine Axis {
    param double limit = 2.5
    var Position place = Position(1, 2, 3)
    initial state Off { transition seen(number, place) if place.x > limit then { do note(number); } select Done }
    final state Done { }
    var int number = 0
}
)"};
inline constexpr ScriptSource good{"cycle.osd", R"(
StateMachine Axis {
    param double limit = 2.5
    var int number = 0
    var Position place = Position(1, 2, 3)
    var vector3 v = vector3(0.5, -1, 1e3)
    initial state Off { transition seen(number, place) if place.x > limit then { do note(number); } select On }
    state On {
        run { for (var int i = 0; i < 3; i = i + 1) { set v[i] = v[i] * 2 + place.y; } do far.moveTo(v.x) timeout 5s; }
        transitions { after(20 ms) select Done }
    }
    final state Done { entry { set mode = fast; } }
}
RootStateMachine Axis left(1.25)
RootStateMachine Axis right()
)"};

template <class Row, class Same>
void expect_same(std::span<const Row> a, std::span<const Row> b, const Same& same) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(same(a[i], b[i])) << "row " << i;
}

TEST(A_compiled_script, has_the_same_rows_as_the_loaded_one) {
    const ScriptUnit& constant = compiled_script<good, peers_of_own>;
    const auto buffer = std::make_unique<ScriptBuffer<buffer_sizes>>();
    Reach reach;
    reach.components = components();
    const ScriptOutcome loaded = compile(good.text, good.name, reach, buffer->room());
    ASSERT_TRUE(loaded.good()) << loaded.fault.view();
    ASSERT_EQ(constant.types.size(), 1u);
    const ProgramTables &a = constant.types[0].tables, &b = loaded.unit.types[0].tables;
    expect_same(a.instructions, b.instructions, [](const Instruction& x, const Instruction& y) {
        return x.run == y.run && x.facet == y.facet && x.to == y.to && x.a == y.a && x.b == y.b &&
               x.link == y.link && x.size == y.size;
    });
    expect_same(a.nodes, b.nodes, [](const NodeRow& x, const NodeRow& y) {
        return x.first == y.first && x.count == y.count && x.first_arc == y.first_arc && x.arcs == y.arcs &&
               x.on_error == y.on_error && x.line == y.line;
    });
    expect_same(a.arcs, b.arcs, [](const ArcRow& x, const ArcRow& y) {
        return x.condition == y.condition && x.to == y.to && x.after == y.after;
    });
    expect_same(a.image, b.image, [](std::byte x, std::byte y) { return x == y; });
    expect_same(constant.types[0].machine.transitions, loaded.unit.types[0].machine.transitions,
                [](const TransitionRow& x, const TransitionRow& y) {
                    return x.from == y.from && x.to == y.to && x.event == y.event && x.after == y.after;
                });
    ASSERT_EQ(constant.instances.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(constant.instances[i].name, loaded.unit.instances[i].name);
        expect_same(constant.instances[i].image, loaded.unit.instances[i].image,
                    [](std::byte x, std::byte y) { return x == y; });
    }
    EXPECT_EQ(constant.command_slots, 2);
}

TEST(A_constant_script, reports_the_same_fault_as_the_loaded_one) {
    const auto buffer = std::make_unique<ScriptBuffer<buffer_sizes>>();
    Reach reach;
    reach.components = components();
    const ScriptOutcome loaded = compile(cycle.text, cycle.name, reach, buffer->room());
    EXPECT_EQ((script_fault_of<cycle, peers_of_own>.view()), loaded.fault.view());
    EXPECT_THAT(std::string{loaded.fault.view()},
                testing::StartsWith("cycle.osd:5:41: found variable \"number\""));
}

} // namespace

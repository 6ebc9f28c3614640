// Program tables with numbers out of bounds are refused before execution (thesis 5.1.1): each number of a
// good table is made wrong in turn.
#include "kernel/program/check_tables.hpp"
#include "tests/kernel/program/fixture.hpp"

#include <gtest/gtest.h>

namespace program_test {

/// A good table whose rows a test can corrupt.
struct Spoilt {
    Instruction instructions[2] = {increment(16, 0), increment(32, 16)};
    ConditionRow conditions[1] = {{1, 1, 32}};
    NodeRow nodes[2];
    ArcRow arcs[2] = {{0, 1, 0}, {no_condition, end_node, no_data}};
    ProgramRow programs[1] = {{"p", 0, 2, true}};
    VariableRow variables[1] = {{"v", script_int, 16, VariableKind::variable}};
    LinkRow links[1];
    std::array<std::byte, 32> image{};
    ProgramTables tables{instructions, conditions, nodes, arcs, programs, variables, links, image, {}};

    Spoilt() {
        nodes[0].count = 1, nodes[0].arcs = 1;
        nodes[1].first_arc = 1, nodes[1].arcs = 1, nodes[1].on_error = 0;
        tables.layout = {16, 32, 32, 48};
    }
    [[nodiscard]] bool refused() const { return !check_tables(tables).empty(); }
};

TEST(A_good_table, is_accepted) { EXPECT_EQ(check_tables(Spoilt{}.tables).view(), ""); }

TEST(A_table, is_refused_when_a_number_in_it_is_out_of_bounds) {
    using Spoil = void (*)(Spoilt&);
    const Spoil spoils[] = {
        [](Spoilt& t) { t.instructions[0].to = 0; }, // a constant
        [](Spoilt& t) { t.instructions[0].to = 48; },
        [](Spoilt& t) { t.instructions[0].a = 48; },
        [](Spoilt& t) { t.instructions[0].b = 0xfff0; },
        [](Spoilt& t) { t.instructions[0].run = nullptr; },
        [](Spoilt& t) {
            static const Facet facet;
            t.instructions[0].facet = &facet;
            t.instructions[0].link = 1;
        },
        [](Spoilt& t) { t.conditions[0].first = 2; },
        [](Spoilt& t) { t.conditions[0].count = 0xffff; },
        [](Spoilt& t) { t.conditions[0].result = 48; },
        [](Spoilt& t) { t.arcs[0].condition = 1; },
        [](Spoilt& t) { t.arcs[0].to = 2; },
        [](Spoilt& t) { t.arcs[0].after = 32; }, // not kept from step to step
        [](Spoilt& t) { t.nodes[0].first = 2; },
        [](Spoilt& t) { t.nodes[0].count = 3; },
        [](Spoilt& t) { t.nodes[1].first_arc = 2; },
        [](Spoilt& t) { t.nodes[1].on_error = 2; },
        [](Spoilt& t) { t.programs[0].first = 3; },
        [](Spoilt& t) { t.programs[0].first = no_node; },
        [](Spoilt& t) { t.programs[0].last = 3; },
        [](Spoilt& t) { t.variables[0].at = 48; },
        [](Spoilt& t) { t.variables[0].type = nullptr; },
        [](Spoilt& t) { t.tables.layout.constants = 64; },
        [](Spoilt& t) { t.tables.layout.arguments = 16; },
        [](Spoilt& t) { t.tables.layout.variables = 16; },
    };
    for (std::size_t i = 0; i < std::size(spoils); ++i) {
        Spoilt table;
        spoils[i](table);
        EXPECT_TRUE(table.refused()) << "spoil " << i;
    }
}

} // namespace program_test

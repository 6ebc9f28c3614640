// State machines as UML state charts (thesis 5.2, figure 5.15): the picture shows everything that the table
// contains.
#include "tests/toolchain/tools/chart/sample.hpp"
#include "toolchain/tools/chart/plantuml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace tappet::chart {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Plantuml, shows_states_inside_states_and_regions_side_by_side) {
    const std::string text = to_plantuml(press());
    EXPECT_THAT(text, HasSubstr("state \"working\" as s_working {\n"
                                "  state \"up\" as s_up\n"
                                "  state \"down\" as s_down\n"
                                "  s_down : exit / lift\n"
                                "  [*] --> s_up\n"
                                "s_up --> s_down : panel.stroke\n"
                                "s_down --> s_up : after 20 ms\n"
                                "  --\n"
                                "  state \"cold\" as s_cold\n"
                                "  state \"hot\" as s_hot\n"
                                "  [*] --> s_cold\n"
                                "s_cold --> s_hot : [warm]\n"
                                "s_hot --> s_cold : panel.stroke\\nthe stroke &#60;cools> it\n"
                                "}\n"));
    EXPECT_THAT(text, HasSubstr("\n[*] --> s_idle\n"));
}

TEST(Plantuml, names_the_cpp_programs_of_states_and_transitions) {
    EXPECT_THAT(to_plantuml(press()), HasSubstr("s_idle : entry / lift\n"));
    EXPECT_THAT(to_plantuml(press()), HasSubstr("[closed] / count"));
}

TEST(Plantuml, shows_an_else_branch_as_a_choice) {
    const std::string text = to_plantuml(press());
    EXPECT_THAT(text, HasSubstr("s_idle --> c_0 : panel.start\n"));
    EXPECT_THAT(text, HasSubstr("c_0 --> s_held : [else]\n"));
    EXPECT_THAT(text, HasSubstr("c_0 --> s_working : [closed] / count\n"));
}

TEST(Plantuml, shows_time_history_internal_reactions_and_reasons) {
    const std::string text = to_plantuml(press());
    EXPECT_THAT(text, HasSubstr("s_held --> s_idle : after 1500 us\n"));
    EXPECT_THAT(text, HasSubstr("s_held --> s_working : panel.go (deep history)\n"));
    EXPECT_THAT(text, HasSubstr("s_held : panel.mark / count\n"));
}

TEST(Plantuml, shows_the_transitions_that_every_machine_has) {
    EXPECT_THAT(to_plantuml(press()), HasSubstr("any state --> safe\n  safe --> idle\n"));
    Chart chart = press();
    std::array<StateRow, press_states.size()> states = press_states;
    states.back().final = false;
    chart.machine.states = states;
    EXPECT_THAT(to_plantuml(chart), Not(HasSubstr("always valid")));
}

TEST(Plantuml, is_accepted_by_its_own_tool) {
    if (std::system("command -v plantuml dot >/dev/null") != 0) // NOLINT: a tool of the host
        GTEST_SKIP() << "plantuml is not installed; ci/setup does it";
    const auto place = std::filesystem::path{testing::TempDir()} / "tappet_chart_press.puml";
    const auto draws = [&](const std::string& text) {
        std::ofstream{place} << text;
        return std::system(("plantuml -checkonly '" + place.string() + "' >/dev/null 2>&1").c_str()) ==
               0; // NOLINT
    };
    EXPECT_TRUE(draws(to_plantuml(press())));
    EXPECT_FALSE(draws("@startuml\nstate (((\n@enduml\n")) << "a tool that takes everything shows nothing";
    std::filesystem::remove(place);
}

TEST(Names, mark_functions_that_have_no_symbol) {
    EXPECT_EQ(function_name(StateProgram{}), "c++");
    EXPECT_EQ(function_name(press_states[0].entry.call), "lift");
    EXPECT_EQ(identifier("cycle.left-1"), "cycle_left_1");
    EXPECT_EQ(time_text(3s), "3 s");
    EXPECT_EQ(time_text(Duration{7}), "7 ns");
    EXPECT_EQ(xml_text("a<b & \"c\""), "a&lt;b &amp; &quot;c&quot;");
}

} // namespace
} // namespace tappet::chart

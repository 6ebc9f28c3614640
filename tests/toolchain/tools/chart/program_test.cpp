// A machine's chart program as a user runs it: the chart of its table, its behaviours, and its refusals.
#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <vector>

namespace tappet::chart {
namespace {

using test::contents_of;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
namespace fs = std::filesystem;

struct ChartProgram : testing::Test {
    test::Folder folder;

    [[nodiscard]] Ended run(const std::string& program, const std::string& words) const {
        return run_line("'" + program + "' --to '" + (folder / "charts").string() + "' " + words);
    }
    std::string made(const std::string& program, const std::string& words, const std::string& name) const {
        const Ended ended = run(program, words);
        EXPECT_EQ(ended.exit_code, 0) << ended.text;
        return contents_of(folder / "charts" / name);
    }
};

TEST_F(ChartProgram, shows_period_deadline_and_priority_of_every_activity) {
    const std::string table = made(CUTTER_CHART, "dot", "cut_to_length.dot");
    EXPECT_THAT(table,
                HasSubstr("label=\"can\\non device of can, at most 4 in 1 ms\\ndeadline 500 us, priority"));
    EXPECT_THAT(table, HasSubstr("label=\"line\\nevery 5 ms\\ndeadline 5 ms, priority"));
    EXPECT_THAT(table, HasSubstr("label=\"browser\\nevery 20 ms\\nnot real-time\""));
    EXPECT_THAT(table, HasSubstr("c3 [label=\"line\\n(line_states)\"];"))
        << "with the behaviour that drives it";
}

TEST_F(ChartProgram, shows_data_as_solid_and_triggers_as_dashed_arrows) {
    const std::string table = made(CUTTER_CHART, "dot", "cut_to_length.dot");
    EXPECT_THAT(table, HasSubstr("c0 -> c2 [label=\"wheel.position → code, stale after 20 ms, wakes\"];"));
    EXPECT_THAT(table,
                HasSubstr("c0 -> c3 [label=\"feed.statusword, stale after 50 ms\\nfaulted → bus_faulted\"];"))
        << "the rows between the same two are one arrow";
    EXPECT_THAT(table,
                HasSubstr("c2 -> c1 [label=\"cut.enters: tell knife.set\\ncut.leaves: tell knife.clear\", "
                          "style=dashed"));
    EXPECT_THAT(table, HasSubstr("c1 -> c3 [label=\"start.rises\\nstop.rises\", style=dashed"))
        << "what a state machine hears";
    EXPECT_THAT(table, HasSubstr("d0 [label=\"feed-can\", shape=box3d"));
    EXPECT_THAT(table, HasSubstr("d0 -> c0 [dir=both"));
}

TEST_F(ChartProgram, shows_the_requests_and_programs_of_a_compiled_script) {
    const std::string table = made(TRACKER_CHART, "dot plantuml scxml", "car_tracking.dot");
    EXPECT_THAT(table, HasSubstr("c4 -> c2 [label=\"start\\nstop\\nmove_camera\\ncalibrate\\n"));
    const std::string states = contents_of(folder / "charts/car_tracking.tracking.puml");
    EXPECT_THAT(states, HasSubstr("state \"LocaliseCar\""));
    EXPECT_THAT(states, HasSubstr("panel.start_calibration"));
    EXPECT_THAT(contents_of(folder / "charts/car_tracking.tracking.LocaliseCar_run.puml"),
                HasSubstr("n12 : camera.fetch_image()\n"));
    EXPECT_THAT(contents_of(folder / "charts/car_tracking.tracking.scxml"), HasSubstr("<scxml"));
}

TEST_F(ChartProgram, names_the_cpp_programs_of_a_machine) {
    EXPECT_THAT(made(CUTTER_CHART, "plantuml", "cut_to_length.line.puml"),
                HasSubstr("s_running : entry / enter_running"));
}

TEST_F(ChartProgram, refuses_unknown_words_before_it_writes) {
    const Ended word = run(CUTTER_CHART, "dott");
    EXPECT_EQ(word.exit_code, 2);
    EXPECT_EQ(word.text, "cut-to-length: word dott is unknown; did you mean dot?\n");
    EXPECT_EQ(run(CUTTER_CHART, "--too x").text,
              "cut-to-length: option --too is unknown; did you mean --to?\n");
    EXPECT_FALSE(fs::exists(folder / "charts"));
}

TEST_F(ChartProgram, says_where_it_cannot_write) {
    std::ofstream{folder / "charts"} << "no folder\n";
    const Ended ended = run(CUTTER_CHART, "dot");
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.text, HasSubstr("charts/cut_to_length.dot cannot be written; check"));
}

/// The words of a drawing without their positions, which depend on the version of dot and on the font.
std::vector<std::string> words_of(const std::string& svg) {
    static const std::regex word{"<(title|text)[^>]*>([^<]*)</"};
    std::vector<std::string> found;
    for (std::sregex_iterator at(svg.begin(), svg.end(), word), end; at != end; ++at)
        found.push_back((*at)[1].str() + " " + (*at)[2].str());
    std::ranges::sort(found);
    return found;
}

TEST_F(ChartProgram, draws_the_picture_of_the_readme) {
    if (std::system("command -v dot plantuml >/dev/null") != 0) // NOLINT: a tool of the host
        GTEST_SKIP() << "graphviz or plantuml is not installed; ci/setup does it";
    const std::string drawn = made(CUTTER_CHART, "svg", "cut_to_length.svg");
    EXPECT_THAT(contents_of(folder / "charts/cut_to_length.line.svg"), HasSubstr("emergency"));
    EXPECT_THAT(words_of(drawn), Not(IsEmpty()));
    EXPECT_EQ(words_of(drawn), words_of(contents_of(CUTTER_PICTURE)))
        << "the table has changed; cure: cut_to_length-chart --to DIR svg, and copy it to " CUTTER_PICTURE;
}

} // namespace
} // namespace tappet::chart

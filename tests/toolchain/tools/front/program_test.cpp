// The front door as a user sees it: one table gives help and completion of every word, and mistakes are
// reported before anything is built.
#include "tests/toolchain/folder.hpp"
#include "tests/toolchain/program.hpp"
#include "toolchain/tools/front/figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace tappet::front {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;
using testing::StartsWith;
namespace fs = std::filesystem;

const std::vector<std::string> every_word{"new",   "build", "run",   "test",   "chart", "wires",  "figures",
                                          "bench", "image", "flash", "update", "box",   "browse", "scope"};

/// Runs in a new machine's folder, which is removed after the test.
struct Door : testing::Test {
    test::Folder folder;
    Door() {
        EXPECT_EQ(run_line("cd '" + folder.string() + "' && '" TAPPET "' new press --cam").exit_code, 0);
    }

    [[nodiscard]] Ended tappet(const std::string& words) const {
        return run_line("cd '" + (folder / "press").string() + "' && '" TAPPET "' " + words);
    }
    [[nodiscard]] std::string refusal(const std::string& words) const {
        const Ended ended = tappet(words);
        EXPECT_EQ(ended.exit_code, 2) << words;
        EXPECT_FALSE(fs::exists(folder / "press/build")) << words << ": nothing was built, nor configured";
        return ended.text;
    }
    [[nodiscard]] std::vector<std::string> completed(const std::string& words) const {
        std::istringstream said{tappet("--complete " + words).text};
        std::vector<std::string> lines;
        for (std::string line; std::getline(said, line);) lines.push_back(line);
        return lines;
    }
};

TEST_F(Door, helps_with_every_word) {
    const std::string all = tappet("--help").text;
    for (const std::string& word : every_word) {
        EXPECT_THAT(all, HasSubstr("  tappet " + word));
        const Ended help = tappet(word + " --help");
        EXPECT_EQ(help.exit_code, 0) << word;
        EXPECT_THAT(help.text, Not(IsEmpty())) << word;
    }
    EXPECT_THAT(tappet("run --help").text, HasSubstr("--seed N"));
    EXPECT_THAT(tappet("chart --help").text, HasSubstr("promela"));
    EXPECT_FALSE(fs::exists(folder / "press/build"));
}

TEST_F(Door, refuses_an_option_of_another_word_before_it_builds) {
    EXPECT_EQ(refusal("run --to charts"), "tappet: option --to belongs to tappet chart, not to tappet run\n");
    EXPECT_EQ(refusal("bench --seed 3"),
              "tappet: option --seed belongs to tappet run, not to tappet bench\n");
    EXPECT_EQ(refusal("build --can"), "tappet: option --can belongs to tappet new, not to tappet build\n");
    EXPECT_EQ(refusal("test --for 3"), "tappet: option --for belongs to tappet run, not to tappet test\n");
}

TEST_F(Door, refuses_an_unknown_option_before_it_builds) {
    EXPECT_EQ(refusal("run --runs 3"),
              "tappet: run: option --runs is unknown, and no source file here names it; see "
              "--help; words after -- go to the machine unchecked\n");
    for (const std::string word : {"build", "test", "chart", "figures", "bench"})
        EXPECT_THAT(refusal(word + " --rums 3"),
                    StartsWith("tappet: " + word + ": option --rums is unknown"));
    EXPECT_THAT(refusal("run --sed 3"), HasSubstr("did you mean --seed?"));
}

TEST_F(Door, refuses_an_invalid_value_before_it_builds) {
    EXPECT_EQ(refusal("run --seed"), "tappet: run: option --seed needs a value after it; see --help\n");
    EXPECT_EQ(refusal("run --for 0"), "tappet: run: option --for: \"0\" is not from 1 to 1000000000\n");
    EXPECT_THAT(refusal("bench --for soon"),
                HasSubstr("\"soon\" is not a whole number; write for example --for 60"));
    EXPECT_THAT(refusal("figures --for"), HasSubstr("option --for needs a value after it"));
    EXPECT_EQ(refusal("chart sgv"), "tappet: chart: word sgv is unknown; did you mean svg?\n");
    EXPECT_EQ(refusal("run --machine pres"),
              "tappet: there is no machine \"pres\" here; did you mean press?\n");
    EXPECT_THAT(refusal("biuld"), HasSubstr("\"biuld\" is not a command; did you mean build?"));
}

TEST_F(Door, refuses_an_image_of_a_board_that_the_machine_does_not_name) {
    EXPECT_EQ(refusal("image"), "tappet: image: name one board: tappet image my_box\n");
    EXPECT_EQ(refusal("image my_bix"),
              "tappet: image: press has no firmware for board \"my_bix\"; did you mean my_box?\n");
    EXPECT_THAT(refusal("image --machine pres my_box"), HasSubstr("there is no machine \"pres\" here"));
    EXPECT_THAT(refusal("image my_box --watchdog 256"), HasSubstr("\"256\" is not from 0 to 255"));
}

TEST_F(Door, flashes_only_disks) {
    EXPECT_THAT(refusal("flash"), HasSubstr("say flash --image disk.img DEVICE"));
    EXPECT_THAT(refusal("flash --image CMakeLists.txt /dev/null"), HasSubstr("is neither a disk nor a file"));
}

TEST_F(Door, refuses_to_write_two_machines_at_once) {
    EXPECT_THAT(refusal("new a b"), HasSubstr("\"b\" is too much"));
}

TEST_F(Door, completes_words_their_options_and_machines) {
    EXPECT_THAT(completed("''"), IsSupersetOf(every_word));
    EXPECT_EQ(completed("fi"), std::vector<std::string>{"figures"});
    EXPECT_EQ(completed("run --su"), std::vector<std::string>{"--summary"});
    EXPECT_THAT(completed("new --"), IsSupersetOf({"--can", "--modbus", "--cam", "--help"}));
    EXPECT_EQ(completed("chart p"), (std::vector<std::string>{"plantuml", "promela"}));
    EXPECT_EQ(completed("bench --machine ''"), std::vector<std::string>{"press"});
    EXPECT_THAT(completed("build ''"), Contains("press-chart"));
    EXPECT_THAT(completed("run --summary ''"), IsEmpty()) << "the shell's own: a file";
    std::ofstream{folder / "press/CMakeLists.txt", std::ios::app} << "tappet_machine(lathe TABLE a.hpp)\n";
    EXPECT_EQ(completed("bench --machine ''"), (std::vector<std::string>{"press", "lathe"}));
}

TEST_F(Door, completes_in_bash) {
    const Ended ended =
        run_line("cd '" + (folder / "press").string() +
                 "' && bash --norc -c 'source \"" TAPPET_BASH "\"; COMP_WORDS=(\"" TAPPET
                 "\" run --qu); COMP_CWORD=2; _tappet \"" TAPPET "\"; echo \"${COMPREPLY[*]}\"'");
    EXPECT_EQ(ended.text, "--quiet\n");
}

TEST(Figures, show_the_measurements_beside_the_claims_of_the_rows) {
    const auto text =
        figures_of(R"({"machine": "press", "world": "host", "kernel_release": "6.1", "realtime": false,
        "activities": [{"name": "cell", "cycles": 7, "most_processor_us": 12.25, "claim_us": 60,
                        "longest_response_us": 80, "deadline_us": 5000, "deadline_misses": 1},
                       {"name": "browser", "cycles": 3, "most_processor_us": 0, "claim_us": 0,
                        "longest_response_us": 0, "deadline_us": 0, "deadline_misses": 0}]})");
    ASSERT_TRUE(text) << text.error();
    EXPECT_THAT(*text, HasSubstr("press on host, 6.1, not PREEMPT_RT: the responses are those of this host"));
    EXPECT_THAT(*text, testing::ContainsRegex("cell +7 +12.2 +60.0 +80.0 +5000.0 +1\n"));
    EXPECT_THAT(*text, testing::ContainsRegex("browser +3 +- +- +- +- +0\n"));
}

TEST(Figures, need_a_valid_summary) {
    EXPECT_THAT(figures_of("").error(), HasSubstr("the summary cannot be read"));
    EXPECT_THAT(figures_of("{}").error(), HasSubstr("machine"));
}

} // namespace
} // namespace tappet::front

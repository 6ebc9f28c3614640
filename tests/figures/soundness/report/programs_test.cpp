// Programs that end well, badly, late or without a result; shell scripts take their place.
#include "tests/figures/report/options.hpp"
#include "tests/figures/report/programs.hpp"
#include "tests/figures/report/surroundings.hpp"
#include "tests/figures/soundness/report/runs.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

namespace tappet::figures {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

struct Programs : testing::Test {
    Programs() { fs::create_directories(folder); }
    ~Programs() override { fs::remove_all(folder); }
    std::string folder = testing::TempDir() + "figures-programs";

    Program program(const std::string& name, const std::string& body) {
        fs::create_directories(folder + "/" + name);
        const std::string path = folder + "/" + name + "/figures-" + name;
        std::ofstream{path} << "#!/bin/sh\n" << body << "\n";
        fs::permissions(path, fs::perms::owner_all);
        return {name, path};
    }
    ProgramRun run(const Program& which, double limit = 20) {
        return run_program(which, {"--brief"}, folder + "/out.json", folder + "/out.log", limit);
    }
};

TEST_F(Programs, a_result_is_read_and_the_arguments_are_passed_on) {
    const std::string sample = folder + "/sample.json";
    ASSERT_EQ(result("exchange", 12).write(sample), "");
    Program good = program("good", "echo \"$@\"; cp " + sample + " \"$2\"");
    good.only = "good.local";
    const ProgramRun told = run(good);
    EXPECT_EQ(told.failure, "");
    ASSERT_EQ(told.result.figures.size(), 1u);
    EXPECT_EQ(told.result.figures[0].rows[0].summary.median, 12);
    std::string said;
    std::getline(std::ifstream{folder + "/out.log"} >> std::ws, said);
    EXPECT_EQ(said, "--json " + folder + "/out.json --only good.local --brief");
}

TEST_F(Programs, a_failed_one_is_reported_with_its_last_output) {
    EXPECT_THAT(run(program("bad", "echo first; echo why >&2; exit 3")).failure,
                AllOf(StartsWith("ended with exit code 3"), HasSubstr("first\nwhy")));
    EXPECT_THAT(run(program("killed", "kill -SEGV $$")).failure,
                StartsWith("was ended by signal Segmentation"));
    EXPECT_THAT(run({"absent", folder + "/absent"}).failure, StartsWith("could not be started"));
}

TEST_F(Programs, the_result_of_an_earlier_run_does_not_stand_for_this_one) {
    ASSERT_EQ(result("exchange", 12).write(folder + "/out.json"), "");
    const ProgramRun told = run(program("silent", "exit 0"));
    EXPECT_THAT(told.failure, AllOf(HasSubstr("told no result"), HasSubstr("there is no")));
    EXPECT_TRUE(told.result.figures.empty());
}

TEST_F(Programs, a_broken_result_is_a_failure) {
    EXPECT_THAT(run(program("empty", ": > \"$2\"")).failure, HasSubstr("is empty"));
    EXPECT_THAT(run(program("cut", "echo '{\"program\": \"cu' > \"$2\"")).failure,
                HasSubstr("is no result of figures"));
    EXPECT_THAT(run(program("other", "echo '{\"program\": \"other\"}' > \"$2\"")).failure,
                HasSubstr("setting"));
}

TEST_F(Programs, a_hung_one_is_killed_with_all_its_children) {
    const auto begin = std::chrono::steady_clock::now();
    const std::string mark = folder + "/mark";
    EXPECT_THAT(run(program("late", "(sleep 0.6; touch " + mark + ") & sleep 60"), 0.2).failure,
                StartsWith("was ended after 0 s"));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{30});
    std::this_thread::sleep_for(std::chrono::milliseconds{900});
    EXPECT_FALSE(fs::exists(mark)) << "its child lived on";
}

TEST_F(Programs, are_found_by_name_with_the_floors_first) {
    program("exchange", "");
    program("floors", "");
    program("dispatch", "");
    std::ofstream{folder + "/dispatch/figures-no-program"} << "";
    const auto found = find_programs(folder);
    ASSERT_TRUE(found) << found.error();
    std::vector<std::string> names;
    for (const Program& each : *found) names.push_back(each.name);
    EXPECT_THAT(names, testing::ElementsAre("floors", "dispatch", "exchange"));
}

TEST_F(Programs, a_folder_without_any_is_refused) {
    EXPECT_THAT(find_programs(folder).error(), HasSubstr("no program of figures"));
    EXPECT_THAT(find_programs(folder + "/nowhere").error(), HasSubstr("no program of figures"));
}

TEST_F(Programs, are_chosen_by_name_or_by_the_prefix_of_a_figures_id) {
    const std::vector<Program> all{{"floors", "f"}, {"exchange", "e"}};
    EXPECT_EQ(choose(all, {})->size(), 2u);
    const auto chosen = choose(all, {"exchange.local", "floors"});
    ASSERT_TRUE(chosen);
    EXPECT_EQ(chosen->at(0).only, "exchange.local");
    EXPECT_EQ(chosen->at(1).only, "");
    EXPECT_THAT(choose(all, {"exchnge"}).error(),
                AllOf(HasSubstr("'exchnge'"), HasSubstr("floors, exchange")));
}

TEST(ReportOptions, wrong_words_are_refused_by_name) {
    const auto refused = [](std::vector<std::string> words) {
        words.insert(words.begin(), {"--output", "o", "--programs", "p"});
        return read_report_options(words).error();
    };
    EXPECT_THAT(refused({"--fast"}), HasSubstr("'--fast' is no option"));
    EXPECT_THAT(refused({"--only"}), HasSubstr("'--only' lacks its value"));
    EXPECT_THAT(refused({"--rounds", "six"}), HasSubstr("not 'six'"));
    EXPECT_THAT(refused({"--rounds", "2"}), HasSubstr("from 3 to 1000"));
    EXPECT_THAT(refused({"--rounds", "4.5"}), HasSubstr("whole number"));
    EXPECT_THAT(refused({"--limit", "-1"}), HasSubstr("takes a number"));
    EXPECT_THAT(read_report_options({}).error(), HasSubstr("--output DIR is missing"));
    EXPECT_THAT(read_report_options({"--output", "o"}).error(), HasSubstr("--programs DIR is missing"));
}

TEST(ReportOptions, are_read) {
    const auto options = read_report_options({"--programs", "p", "--output", "o", "--only", "a", "--only",
                                              "b.c", "--rounds", "9", "--margin", "2.5", "--no-counts"});
    ASSERT_TRUE(options) << options.error();
    EXPECT_THAT(options->only, testing::ElementsAre("a", "b.c"));
    EXPECT_EQ(options->rounds, 9u);
    EXPECT_EQ(options->margin_percent, 2.5);
    EXPECT_FALSE(options->counts);
    EXPECT_EQ(options->setting, "short");
}

TEST(Surroundings, the_machine_is_described_without_gaps) {
    for (const auto& [what, value] : describe_machine()) EXPECT_NE(value, "") << what;
}

TEST(Surroundings, noise_is_what_lies_above_the_median) {
    const Noise noise = measure_noise(0, 0.1);
    EXPECT_GT(noise.work_us, 0);
    EXPECT_GE(noise.spread_percent, 0);
    EXPECT_GE(noise.worst_percent, noise.spread_percent);
    EXPECT_GE(noise.lost_percent, 0);
    EXPECT_LE(noise.lost_percent, 100);
}

} // namespace
} // namespace tappet::figures

// The verdict on the counts of firmware and plant, and the command line.
#include "apps/carpet_loom/demo/scenario.hpp"
#include "apps/carpet_loom/demo/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <vector>

namespace tappet::demo {
namespace {

using nlohmann::ordered_json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

ordered_json machine() {
    return ordered_json::parse(
        R"({"machine": "carpet-loom", "board": "bench", "kernel_release": "6.1-rt", "realtime": true, "can_frames_lost": 0,
        "gpio_edges_lost": 0, "counters": {"utility.outages_survived": 1}, "emissions_lost": 0, "heap_allocations_after_arming": 0, "page_faults_after_arming": 0,
        "deadline_misses": 0, "binary_bytes": 1300000, "static_memory_bytes": 1100000, "rss_bytes": 2500000,
        "slots": [{"component": "weft", "script": "", "loads": 0, "roll_backs": 0, "news": ""}],
        "activities": [{"name": "motion", "cycles": 11, "longest_busy_us": 1.5, "most_processor_us": 0, "claim_us": 60, "over_claim": 0, "longest_response_us": 2.5, "deadline_misses": 0}]})");
}

ordered_json plant() {
    return ordered_json::parse(
        R"({"seed": 12, "time_s": 7.5, "picks": 30, "picks_per_minute": 448.7, "weft_breaks_injected": 1,
        "warp_breaks_injected": 0, "stops_total": 2, "stops": [{"cause": "weft", "angle_deg": 316.0, "error_deg": 6.0, "at_pick": 9},
        {"cause": "emergency", "angle_deg": 57.0, "error_deg": 107.0, "at_pick": 15}],
        "cam_error_deg": {"samples": 32, "p50": 0.14, "p99": 0.47, "max": 0.48}, "frames_lost": 13, "deadline_misses": 99,
        "patterns": [{"pattern": 23130, "picks": 15, "first_at_pick": 1}], "damage": {"total": 0}})");
}

/// Both as one object, as far as their keys differ.
ordered_json good_run() {
    ordered_json run = plant();
    run.update(machine());
    return run;
}

std::expected<Verdict, std::string> verdict_of(const ordered_json& run, std::int64_t picks = 30) {
    ordered_json left = machine(), right = plant();
    for (const auto& [key, value] : run.items()) (left.contains(key) ? left : right)[key] = value;
    return judge(left.dump(), right.dump(), picks);
}
std::vector<std::string> faults_of(const ordered_json& run, std::int64_t picks = 30) {
    return verdict_of(run, picks).value().faults;
}

TEST(Verdict, finds_nothing_in_a_good_run_wherever_its_emergency_stop_ended) {
    EXPECT_THAT(faults_of(good_run()), IsEmpty());
}

TEST(Verdict, names_a_stop_that_is_too_far_off_on_either_side) {
    auto run = good_run();
    run["stops"][0]["error_deg"] = 10.01;
    EXPECT_THAT(faults_of(run), ElementsAre(AllOf(HasSubstr("weft stop"), HasSubstr("pick 9"))));
    run["stops"][0]["error_deg"] = -10.01;
    EXPECT_EQ(faults_of(run).size(), 1U);
    run["stops"][0]["error_deg"] = -10.0;
    EXPECT_THAT(faults_of(run), IsEmpty());
}

TEST(Verdict, names_a_stop_for_which_nothing_was_injected) {
    auto run = good_run();
    run["stops"][0]["cause"] = "machine";
    EXPECT_THAT(faults_of(run), ElementsAre(HasSubstr("stopped after pick 9")));
}

TEST(Verdict, names_an_activity_that_used_more_of_the_processor_than_its_row_claims) {
    auto run = good_run();
    run["activities"][0]["over_claim"] = 3;
    run["activities"][0]["most_processor_us"] = 80;
    EXPECT_THAT(faults_of(run),
                ElementsAre(AllOf(HasSubstr("\"motion\""), HasSubstr("3 times"), HasSubstr("80 us of 60"))));
    EXPECT_THAT(verdict_of(run).value().table, HasSubstr("80/60 us"));
}

TEST(Verdict, names_a_missing_pick_and_a_kernel_that_is_not_real_time) {
    auto run = good_run();
    run["picks"] = 29;
    run["realtime"] = false;
    EXPECT_THAT(faults_of(run), ElementsAre(HasSubstr("real-time"), HasSubstr("29 of 30")));
}

TEST(Verdict, names_everything_that_must_be_zero) {
    for (const char* key : {"can_frames_lost", "gpio_edges_lost", "emissions_lost",
                            "heap_allocations_after_arming", "page_faults_after_arming", "deadline_misses"}) {
        auto run = good_run();
        run[key] = 77;
        EXPECT_THAT(faults_of(run), ElementsAre(HasSubstr("77"))) << key;
    }
    auto run = good_run();
    run["damage"]["total"] = 1;
    EXPECT_EQ(faults_of(run).size(), 1U);
}

TEST(Verdict, requires_a_new_weave_and_one_roll_back_of_a_long_run) {
    auto run = good_run();
    run["picks"] = 60;
    const auto faults = [&] { return faults_of(run, 60); };
    EXPECT_THAT(faults(), ElementsAre(HasSubstr("twill.osd"), HasSubstr("0 were rolled back")));
    run["slots"][0] = {{"script", "twill.osd"}, {"loads", 2}, {"roll_backs", 1}, {"news", "line 6"}};
    EXPECT_THAT(faults(), ElementsAre(HasSubstr("0 picks were woven with its pattern")));
    run["patterns"].push_back({{"pattern", pattern_of_new_weave}, {"picks", 9}, {"first_at_pick", 20}});
    EXPECT_THAT(faults(), IsEmpty());
    EXPECT_THAT(verdict_of(run, 60).value().table,
                AllOf(HasSubstr("1111 from pick 20 on"), HasSubstr("line 6")));
    run["slots"][0]["roll_backs"] = 2;
    EXPECT_THAT(faults(), ElementsAre(HasSubstr("2 were rolled back")));
}

TEST(Verdict, shows_the_run_in_a_table) {
    EXPECT_THAT(verdict_of(good_run()).value().table,
                AllOf(HasSubstr("carpet-loom on board bench"), HasSubstr("6.1-rt"), HasSubstr("30 picks"),
                      HasSubstr("316.00 deg, error  +6.00"), HasSubstr("p99 0.47"), HasSubstr("motion")));
}

TEST(Summary, keeps_the_machines_fields_and_adds_the_plants_measurements) {
    const auto whole = ordered_json::parse(verdict_of(good_run()).value().summary);
    const auto of_machine = machine(), of_plant = plant();
    for (const auto& [key, value] : of_machine.items()) EXPECT_EQ(whole.at(key), value) << key;
    for (const char* key : {"seed", "picks", "picks_per_minute", "weft_breaks_injected",
                            "warp_breaks_injected", "stops", "cam_error_deg", "damage", "patterns"})
        EXPECT_EQ(whole.at(key), of_plant.at(key)) << key;
    EXPECT_EQ(whole.at("plant").at("frames_lost"), 13);
    EXPECT_EQ(whole.at("plant").at("deadline_misses"), 99);
    EXPECT_FALSE(whole.at("plant").contains("picks")) << "nothing is said twice";
}

TEST(Summary, is_refused_with_the_name_of_a_missing_or_mistyped_field) {
    for (const char* key :
         {"machine", "realtime", "can_frames_lost", "counters", "slots", "binary_bytes", "activities"}) {
        auto left = machine();
        left.at(key) = nullptr;
        EXPECT_THAT(judge(left.dump(), plant().dump(), 30).error(), HasSubstr(key));
        left.erase(key);
        EXPECT_THAT(judge(left.dump(), plant().dump(), 30).error(), HasSubstr(key));
    }
    for (const char* key : {"picks", "stops", "cam_error_deg", "damage", "stops_total"}) {
        auto right = plant();
        right.erase(key);
        EXPECT_THAT(judge(machine().dump(), right.dump(), 30).error(), HasSubstr(key));
    }
    auto run = good_run();
    run["stops"][0].erase("error_deg");
    EXPECT_THAT(verdict_of(run).error(), AllOf(HasSubstr("stops"), HasSubstr("error_deg")));
    run = good_run();
    run["deadline_misses"] = -1;
    EXPECT_THAT(verdict_of(run).error(), HasSubstr("deadline_misses"));
    EXPECT_FALSE(judge("", plant().dump(), 30));
    EXPECT_FALSE(judge(machine().dump(), plant().dump().substr(0, 100), 30));
    EXPECT_FALSE(judge("[1, 2]", plant().dump(), 30));
}

std::expected<CommandLine, std::string> options_of(std::vector<std::string_view> words) {
    return read_options(words);
}
const std::vector<std::string_view> files{"--firmware",   "f", "--plant", "p", "--browser", "b",
                                          "--behaviours", "w", "--init",  "i", "--summary", "s"};

std::vector<std::string_view> with(std::vector<std::string_view> more) {
    more.insert(more.end(), files.begin(), files.end());
    return more;
}

TEST(DemoOptions, have_defaults) {
    const auto options = options_of(files);
    ASSERT_TRUE(options) << options.error();
    const bench::Scenario scenario = scenario_of(*options);
    EXPECT_THAT(scenario.commands.front(), HasSubstr(" --seed 1 --picks 200 "));
}

TEST(DemoOptions, take_picks_and_seed) {
    const auto options = options_of(with({"--picks", "30", "--plain", "--seed", "18446744073709551615"}));
    ASSERT_TRUE(options) << options.error();
    EXPECT_THAT(scenario_of(*options).commands.front(),
                HasSubstr(" --seed 18446744073709551615 --picks 30 "));
    EXPECT_TRUE(options->has("--plain"));
}

TEST(DemoOptions, refuse_bad_words_with_their_name) {
    for (const auto& [words, named] :
         std::initializer_list<std::pair<std::vector<std::string_view>, const char*>>{
             {{"--picks", "0"}, "--picks"},
             {{"--picks", "-3"}, "--picks"},
             {{"--picks", "30x"}, "--picks"},
             {{"--picks", ""}, "--picks"},
             {{"--picks", "100001"}, "--picks"},
             {{"--seed", "-1"}, "--seed"},
             {{"--seed", "18446744073709551616"}, "--seed"},
             {{"--sead", "1"}, "--sead"},
             {{"30"}, "option 30 is"}}) {
        const auto options = options_of(with(words));
        ASSERT_FALSE(options) << named;
        EXPECT_THAT(options.error(), HasSubstr(named));
    }
    auto cut = files;
    cut.push_back("--picks");
    EXPECT_THAT(options_of(cut).error(), HasSubstr("--picks"));
    EXPECT_THAT(options_of({"--plant", "p"}).error(), HasSubstr("--firmware"));
}

} // namespace
} // namespace tappet::demo

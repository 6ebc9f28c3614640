// The merged summary: what it takes from whom, and what it refuses.
#include "apps/carpet_loom/demo/merge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <stdexcept>

namespace tappet::demo {
namespace {

using nlohmann::ordered_json;
using testing::AllOf;
using testing::HasSubstr;

ordered_json machine() {
    return ordered_json::parse(
        R"({"machine": "carpet-loom", "board": "bench", "world": "bench", "kernel_release": "6.1-rt", "realtime": true,
        "machine_seed": 0, "stop_reason": "asked for", "can_frames_lost": 1, "gpio_edges_lost": 2, "counters": {"utility.outages_survived": 3}, "emissions_lost": 4,
        "heap_allocations_after_arming": 5, "page_faults_after_arming": 6, "deadline_misses": 7, "binary_bytes": 8, "static_memory_bytes": 9,
        "rss_bytes": 10, "slots": [{"component": "weft", "script": "", "loads": 0, "roll_backs": 0, "news": ""}], "activities": [{"name": "motion", "cycles": 11, "longest_busy_us": 1.5, "most_processor_us": 0, "claim_us": 60, "over_claim": 0, "longest_response_us": 2.5, "deadline_misses": 0}]})");
}

ordered_json plant() {
    return ordered_json::parse(
        R"({"seed": 12, "time_s": 7.5, "picks": 30, "picks_per_minute": 448.7, "weft_breaks_injected": 1,
        "warp_breaks_injected": 0, "stops_total": 1, "stops": [{"cause": "weft", "angle_deg": 316.0, "error_deg": 6.0, "at_pick": 9}],
        "cam_error_deg": {"samples": 32, "p50": 0.14, "p99": 0.47, "max": 0.47}, "frames_lost": 13, "edges_lost": 14,
        "patterns": [{"pattern": 3, "picks": 30, "first_at_pick": 0}],
        "damage": {"total": 0, "late_wefts": 0}})");
}

ordered_json merged_of(const ordered_json& left, const ordered_json& right) {
    const auto merged = merge(left.dump(), right.dump());
    if (!merged) throw std::runtime_error(merged.error());
    return ordered_json::parse(*merged);
}

std::string error_of(const std::expected<std::string, std::string>& merged) {
    return merged ? "accepted" : merged.error();
}

std::string refusal(const ordered_json& left, const ordered_json& right) {
    return error_of(merge(left.dump(), right.dump()));
}

TEST(Merge, keeps_every_key_of_the_machine_as_it_is) {
    const auto merged = merged_of(machine(), plant());
    const auto whole = machine();
    for (const auto& [key, value] : whole.items()) EXPECT_EQ(merged.at(key), value) << key;
}

TEST(Merge, puts_what_the_plant_measured_of_the_machine_beside_it) {
    const auto merged = merged_of(machine(), plant());
    for (const char* key : {"seed", "picks", "picks_per_minute", "weft_breaks_injected",
                            "warp_breaks_injected", "stops", "cam_error_deg", "damage", "patterns"})
        EXPECT_EQ(merged.at(key), plant().at(key)) << key;
}

TEST(Merge, puts_the_rest_of_the_plants_bookkeeping_under_plant) {
    const auto merged = merged_of(machine(), plant());
    EXPECT_EQ(merged.at("plant").at("frames_lost"), 13);
    EXPECT_EQ(merged.at("plant").at("time_s"), 7.5);
    EXPECT_FALSE(merged.contains("frames_lost"));
    EXPECT_FALSE(merged.at("plant").contains("picks")) << "nothing is said twice";
}

TEST(Merge, has_no_collision_when_the_plant_has_a_key_of_the_machines_among_its_bookkeeping) {
    auto also = plant();
    also["deadline_misses"] = 99;
    const auto merged = merged_of(machine(), also);
    EXPECT_EQ(merged.at("deadline_misses"), 7);
    EXPECT_EQ(merged.at("plant").at("deadline_misses"), 99);
}

TEST(Merge, refuses_a_key_that_both_would_put_in_the_same_place) {
    auto also = machine();
    also["picks"] = 30;
    EXPECT_THAT(refusal(also, plant()), AllOf(HasSubstr("both"), HasSubstr("\"picks\"")));
    also = machine();
    also["plant"] = 1;
    EXPECT_THAT(refusal(also, plant()), HasSubstr("\"plant\""));
}

class MergeKey : public testing::TestWithParam<const char*> {};

TEST_P(MergeKey, is_named_when_it_is_missing_or_of_another_type) {
    auto left = machine();
    auto right = plant();
    auto& whole = left.contains(GetParam()) ? left : right;
    whole.at(GetParam()) = nullptr;
    EXPECT_THAT(refusal(left, right), HasSubstr(GetParam()));
    whole.erase(GetParam());
    EXPECT_THAT(refusal(left, right), AllOf(HasSubstr("lacks"), HasSubstr(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(required, MergeKey,
                         testing::Values("machine", "board", "world", "kernel_release", "realtime",
                                         "stop_reason", "can_frames_lost", "gpio_edges_lost", "counters",
                                         "slots", "emissions_lost", "heap_allocations_after_arming",
                                         "page_faults_after_arming", "deadline_misses", "binary_bytes",
                                         "static_memory_bytes", "rss_bytes", "activities", "seed", "picks",
                                         "picks_per_minute", "weft_breaks_injected", "warp_breaks_injected",
                                         "stops", "cam_error_deg", "damage", "stops_total", "time_s"));

TEST(Merge, looks_into_stops_cam_errors_activities_and_damage) {
    auto right = plant();
    right["stops"][0].erase("error_deg");
    EXPECT_THAT(refusal(machine(), right), AllOf(HasSubstr("stop"), HasSubstr("error_deg")));
    right = plant();
    right["cam_error_deg"].erase("p99");
    EXPECT_THAT(refusal(machine(), right), AllOf(HasSubstr("cam_error_deg"), HasSubstr("p99")));
    right = plant();
    right["damage"].erase("total");
    EXPECT_THAT(refusal(machine(), right), AllOf(HasSubstr("damage"), HasSubstr("total")));
    auto left = machine();
    left["activities"][0]["longest_response_us"] = "fast";
    EXPECT_THAT(refusal(left, plant()), AllOf(HasSubstr("activity"), HasSubstr("longest_response_us")));
}

TEST(Merge, refuses_a_negative_count) {
    auto left = machine();
    left["deadline_misses"] = -1;
    EXPECT_THAT(refusal(left, plant()), HasSubstr("deadline_misses"));
}

TEST(Merge, refuses_what_is_no_json_and_says_whose) {
    EXPECT_THAT(error_of(merge("", plant().dump())), AllOf(HasSubstr("firmware"), HasSubstr("no JSON")));
    const std::string cut = plant().dump().substr(0, 100);
    EXPECT_THAT(error_of(merge(machine().dump(), cut)), AllOf(HasSubstr("plant"), HasSubstr("no JSON")));
    EXPECT_THAT(error_of(merge("[1, 2]", plant().dump())), HasSubstr("no object"));
    EXPECT_THAT(error_of(merge(machine().dump() + "{}", plant().dump())), HasSubstr("no JSON"));
}

TEST(Merge, refuses_a_key_that_is_there_twice) {
    const std::string twice = R"({"picks": 1, "picks": 2})";
    EXPECT_THAT(error_of(merge(machine().dump(), twice)), AllOf(HasSubstr("picks"), HasSubstr("twice")));
}

} // namespace
} // namespace tappet::demo

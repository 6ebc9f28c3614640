// The host's carpet loom as a program: it names each mistake in its command line with a cure and ends with
// exit code 2; and it writes a summary at its end.
#include "tests/apps/carpet_loom/program.hpp"

#include <gmock/gmock.h>

namespace tappet::carpet {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::vector<std::string>& words) {
    const Ended ended = run_loom(words);
    EXPECT_EQ(ended.exit_code, 2);
    return ended.text;
}

TEST(Program, names_the_nearest_option_when_one_is_misspelt) {
    EXPECT_EQ(refusal({"--sede", "3"}), "carpet-loom: option --sede is unknown; did you mean --seed?\n");
    EXPECT_EQ(refusal({"--wirtual"}), "carpet-loom: option --wirtual is unknown; did you mean --virtual?\n");
    EXPECT_EQ(refusal({"xyz"}), "carpet-loom: option xyz is unknown; see --help\n");
}

TEST(Program, names_an_option_without_its_value) {
    EXPECT_EQ(refusal({"--picks", "3", "--seed"}),
              "carpet-loom: option --seed needs a value after it; see --help\n");
}

TEST(Program, refuses_a_value_that_is_not_a_whole_number) {
    for (const char* word : {"", "three", "3.5", "-1", "0x10", "18446744073709551616"}) {
        EXPECT_THAT(refusal({"--seed", word}),
                    HasSubstr("is not a whole number; write for example --seed 60"));
        EXPECT_THAT(refusal({"--picks", word}), StartsWith("carpet-loom: option --picks: \""));
    }
    EXPECT_THAT(refusal({"--for", "0"}), HasSubstr("option --for: \"0\" is not from 1 to 1000000000"));
    EXPECT_THAT(refusal({"--picks", "0"}),
                HasSubstr("\"0\" is not a valid value of this option; see --help"));
}

TEST(Program, ends_with_2_when_the_summary_cannot_be_written) {
    EXPECT_THAT(refusal({"--picks", "1", "--summary", "/nowhere/at/all.json"}),
                HasSubstr("carpet-loom: the summary cannot be written to \"/nowhere/at/all.json\"; name a "
                          "file in a folder that exists\n"));
}

TEST(Program, ends_with_1_when_the_time_was_too_short_for_the_picks) {
    const Ended ended = run_loom({"--picks", "100", "--for", "5"});
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_THAT(ended.text, HasSubstr("carpet-loom: stopped: the picks were not woven in time\n"));
}

TEST(Program, prints_its_options_and_those_of_its_plant_for_help) {
    const Ended ended = run_loom({"--help"});
    EXPECT_EQ(ended.exit_code, 0);
    for (const char* option : {"--real", "--seed", "--summary", "--picks", "--weft-break-one-in"})
        EXPECT_THAT(ended.text, HasSubstr(option));
}

TEST(Program, writes_a_summary_with_every_field_that_is_promised) {
    const std::string path = temporary_file("summary.json");
    ASSERT_EQ(run_loom({"--picks", "20", "--seed", "4", "--summary", path}).exit_code, 0);
    const std::string summary = test::contents_of(path);
    for (const char* field : {"machine",
                              "board",
                              "world",
                              "kernel_release",
                              "realtime",
                              "picks",
                              "picks_per_minute",
                              "weft_breaks_injected",
                              "warp_breaks_injected",
                              "stops",
                              "cam_error_deg",
                              "can_frames_lost",
                              "can.wrong_lengths",
                              "gpio_edges_lost",
                              "utility.outages_survived",
                              "page_faults_after_arming",
                              "deadline_misses",
                              "binary_bytes",
                              "static_memory_bytes",
                              "rss_bytes",
                              "event_log_digest"})
        EXPECT_THAT(summary, HasSubstr("\"" + std::string{field} + "\": ")) << field;
    EXPECT_THAT(summary, HasSubstr("\"realtime\": false"));
    EXPECT_THAT(summary, testing::Not(HasSubstr("heap_allocations_after_arming")))
        << "nobody counts them here";
}

} // namespace
} // namespace tappet::carpet

// The command line of the host's carpet loom: what is wrong is named, with its cure, and ends with exit
// code 2.
#include "apps/carpet_loom/host/options.hpp"
#include "tests/apps/carpet_loom/program.hpp"

#include <gmock/gmock.h>

#include <array>

namespace tappet::carpet {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

template <class... Words>
auto parse(Words... words) {
    const std::array<const char*, sizeof...(Words) + 1> line{"carpet_loom", words...};
    return parse_options(static_cast<int>(line.size()), line.data());
}

template <class... Words>
std::string error_of(Words... words) {
    const auto options = parse(words...);
    return options ? "accepted" : std::string{options.error().view()};
}

TEST(Options, are_those_of_a_short_virtual_run_unless_told_otherwise) {
    const auto options = parse();
    ASSERT_TRUE(options);
    EXPECT_TRUE(options->virtual_time);
    EXPECT_EQ(options->seed, 1u);
    EXPECT_EQ(options->picks, 200u);
    EXPECT_EQ(options->plant.last_pick, 200u);
    EXPECT_TRUE(options->summary.empty());
}

TEST(Options, say_what_is_asked_of_the_plant) {
    const auto options =
        parse("--world", "host", "--real", "--seed", "18446744073709551615", "--picks", "7", "--weft-breaks",
              "3", "--warp-breaks", "0", "--emergency-stops", "9", "--summary", "x.json", "--quiet");
    ASSERT_TRUE(options);
    EXPECT_FALSE(options->virtual_time);
    EXPECT_EQ(options->seed, ~std::uint64_t{0});
    EXPECT_EQ(options->plant.last_pick, 7u);
    EXPECT_EQ(options->plant.weft_break_one_in, 3u);
    EXPECT_EQ(options->plant.warp_break_one_in, 0u);
    EXPECT_EQ(options->plant.emergency_stop_one_in, 9u);
    EXPECT_EQ(options->summary, "x.json");
    EXPECT_TRUE(options->quiet);
}

TEST(Options, name_the_nearest_option_when_one_is_misspelt) {
    EXPECT_EQ(error_of("--sede", "3"), "option --sede is unknown; did you mean --seed?");
    EXPECT_EQ(error_of("--wirtual"), "option --wirtual is unknown; did you mean --virtual?");
    EXPECT_EQ(error_of("xyz"), "option xyz is unknown; see --help");
}

TEST(Options, miss_the_value_that_was_left_out) {
    EXPECT_EQ(error_of("--seed", "3", "--picks"), "option --picks needs a value after it; see --help");
}

TEST(Options, refuse_what_is_no_whole_number) {
    for (const char* word : {"", "three", "3.5", "-1", "0x10", "18446744073709551616"}) {
        const auto options = parse("--picks", word);
        ASSERT_FALSE(options) << word;
        EXPECT_THAT(std::string{options.error().view()},
                    AllOf(StartsWith("option --picks: \"" + std::string{word} + "\" is not a whole number"),
                          HasSubstr("write for example --picks 200")))
            << word;
    }
}

TEST(Options, refuse_to_weave_nothing) {
    EXPECT_THAT(error_of("--picks", "0"), HasSubstr("ask for at least 1"));
}

TEST(Options, refuse_another_world_than_the_host) {
    EXPECT_THAT(error_of("--world", "bench"), AllOf(HasSubstr("host"), HasSubstr("ci/demo")));
}

TEST(Program, ends_with_2_and_says_why_when_its_options_are_wrong) {
    const Ended ended = run_loom({"--sede", "3"});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_EQ(ended.text, "carpet_loom: option --sede is unknown; did you mean --seed?\n");
    EXPECT_EQ(run_loom({"--picks"}).exit_code, 2);
    EXPECT_EQ(run_loom({"--picks", "many"}).exit_code, 2);
}

TEST(Program, ends_with_2_when_the_summary_cannot_be_written) {
    const Ended ended = run_loom({"--quiet", "--picks", "1", "--summary", "/nowhere/at/all.json"});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_EQ(ended.text, "carpet_loom: the summary cannot be written to \"/nowhere/at/all.json\"; name a "
                          "file in a folder that exists\n");
}

TEST(Program, prints_its_options_when_asked) {
    const Ended ended = run_loom({"--help"});
    EXPECT_EQ(ended.exit_code, 0);
    EXPECT_EQ(ended.text, usage);
}

TEST(Program, writes_a_summary_with_every_field_that_is_promised) {
    const std::string path = temporary_file("summary.json");
    ASSERT_EQ(run_loom({"--quiet", "--picks", "20", "--seed", "4", "--summary", path}).exit_code, 0);
    const std::string summary = contents(path);
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
                              "gpio_edges_lost",
                              "modbus_outages_survived",
                              "heap_allocations_after_arming",
                              "page_faults_after_arming",
                              "deadline_misses",
                              "binary_bytes",
                              "static_memory_bytes",
                              "rss_bytes",
                              "event_log_digest"})
        EXPECT_THAT(summary, HasSubstr("\"" + std::string{field} + "\": ")) << field;
    EXPECT_THAT(summary, HasSubstr("\"realtime\": false"));
}

} // namespace
} // namespace tappet::carpet

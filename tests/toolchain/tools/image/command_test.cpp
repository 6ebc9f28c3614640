// ci/image checks its arguments before it builds anything: it lists the machines that have an image, and
// suggests corrections.
#include "tests/toolchain/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tappet::image {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& words) {
    const Ended ended = run_line("'" TAPPET_CI_IMAGE "' " + words);
    EXPECT_EQ(ended.exit_code, 2) << ended.text;
    return ended.text;
}

TEST(ImageCommand, names_the_machines_and_boards_of_a_system) {
    EXPECT_THAT(
        refusal("woodworking_lane"),
        HasSubstr(
            "ci/image: 'woodworking_lane' is several machines, each with an image of its own; name one of "
            "lane_conveyor lane_drill lane_glue lane_polish lane_saw and its board, bench lane_box\n"));
    EXPECT_THAT(refusal("two_robots bench"), HasSubstr("name one of k160 k361 and its board, bench\n"));
}

TEST(ImageCommand, offers_only_what_can_be_built) {
    EXPECT_THAT(
        refusal("carpet_lom"),
        HasSubstr("there is no machine 'carpet_lom' with a firmware for board 'ipc-x86_64'; for it there are "
                  "bearing_press carpet_loom cut_to_length\n"));
    EXPECT_THAT(refusal("car_tracking"),
                HasSubstr("no firmware for board 'ipc-x86_64'; it has for camera_box\n"));
}

TEST(ImageCommand, says_for_which_boards_a_machine_is_built) {
    EXPECT_THAT(refusal("lane_saw"),
                HasSubstr("'lane_saw' has no firmware for board 'ipc-x86_64'; it has for bench lane_box\n"));
    EXPECT_THAT(refusal("carpet_loom nowhere"), HasSubstr("it has for bench ipc-x86_64\n"));
}

} // namespace
} // namespace tappet::image

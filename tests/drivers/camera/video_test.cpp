// A place where no camera is refuses with its cure. Cameras themselves are on the bench: bench_video.cpp.
#include "drivers/camera/video.hpp"

#include <gtest/gtest.h>

namespace tappet::camera {
namespace {

constexpr CameraFacts wanted{.size = {160, 120}, .per_second = 25, .format = Format::yuyv};

TEST(Video, that_is_not_there_is_refused_with_the_cure) {
    Video video;
    const auto opened = video.open("/dev/no-video", wanted);
    ASSERT_FALSE(opened);
    EXPECT_EQ(
        opened.error().view(),
        "it cannot be opened: No such file or directory; plug the camera in and load its driver, or name "
        "another device in the board (v4l2-ctl --list-devices lists them)");
    EXPECT_EQ(video.wait_handle(), -1);
}

TEST(Video, that_is_no_camera_is_refused_with_the_cure) {
    Video video;
    const auto opened = video.open("/dev/null", wanted);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().view(), "it is no camera that streams; name another device in the board "
                                     "(v4l2-ctl --list-devices lists them)");
    EXPECT_EQ(video.wait_handle(), -1) << "nothing stays open";
    Frame frame;
    EXPECT_EQ(video.take(frame, {}, {}), Taken::failed);
}

} // namespace
} // namespace tappet::camera

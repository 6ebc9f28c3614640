// The real camera on Linux's test driver vivid, which is /dev/video0 on the bench. vivid's own controls,
// found by their names, make its faults.
#include "drivers/camera/offers.hpp"
#include "drivers/camera/pixels.hpp"
#include "drivers/camera/video.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/waiter.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <thread>

#include <fcntl.h>
#include <linux/videodev2.h>
#include <malloc.h>
#include <unistd.h>

namespace tappet::camera {
namespace {

constexpr CameraFacts wanted{.size = {320, 180}, .per_second = 25, .format = Format::yuyv};
constexpr const char* path = "/dev/video0";

Time now() { return os::Clock::monotonic(); }

/// Sets a control of the camera, as another program does.
void control(std::string_view name, int value) {
    const int fd = ::open(path, O_RDWR | O_CLOEXEC);
    v4l2_queryctrl each{};
    each.id = V4L2_CTRL_FLAG_NEXT_CTRL;
    int error = -1;
    for (; error != 0 && request(fd, VIDIOC_QUERYCTRL, &each) == 0; each.id |= V4L2_CTRL_FLAG_NEXT_CTRL) {
        if (std::string{reinterpret_cast<const char*>(each.name)} != name) continue;
        v4l2_control set{.id = each.id, .value = value};
        error = request(fd, VIDIOC_S_CTRL, &set);
        EXPECT_EQ(error, 0) << name << ": " << std::strerror(error);
    }
    EXPECT_EQ(error, 0) << name;
    ::close(fd);
}

/// vivid delivers a frame when its exposure begins. Its other stamp, of the frame's end, is then of the
/// future.
enum class StampOf : std::uint8_t { end, exposure };
void set_stamp(StampOf which) { control("Timestamp Source", static_cast<int>(which)); }

// For the machine of another program.
TEST(Control, DISABLED_stamps_at_the_exposure) { set_stamp(StampOf::exposure); }
TEST(Control, DISABLED_unplugs) { control("Disconnect", 1); }

struct Streaming : testing::Test {
    Streaming() { set_stamp(StampOf::exposure); }
    void open(const CameraFacts& facts = wanted) {
        const auto opened = video.open(path, facts);
        ASSERT_TRUE(opened) << opened.error().view();
    }
    static std::string refusal(const CameraFacts& facts) {
        Video other;
        const auto opened = other.open(path, facts);
        return opened ? "none" : std::string{opened.error().view()};
    }
    /// Waits for the next frame that is good or failed.
    Taken take() {
        for (const Time end = now() + 5s; now() < end;) {
            const Taken taken = video.take(frame, now() - 1s, now());
            if (taken == Taken::frame || taken == Taken::failed) return taken;
            if (taken == Taken::nothing) std::this_thread::sleep_for(1ms);
        }
        return Taken::nothing;
    }
    void take_good(int count) {
        for (int i = 0; i < count; ++i) {
            ASSERT_EQ(take(), Taken::frame) << i;
            EXPECT_TRUE(video.give_back());
        }
    }
    Video video;
    Frame frame{};
};

TEST_F(Streaming, delivers_frames_of_the_size_at_the_rate_with_their_times) {
    open();
    os::Waiter waiter;
    ASSERT_TRUE(waiter.watch(video.wait_handle()));
    take_good(5); // the first ones of a stream do not keep the rate
    const Time begin = now();
    Time last = frame.stamp;
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(waiter.wait(now() + 1s)) << "its descriptor is readable";
        ASSERT_EQ(take(), Taken::frame);
        EXPECT_EQ(frame.bytes.size(), 320u * 180u * 2u);
        EXPECT_EQ(frame.row_bytes, 640u);
        EXPECT_NEAR(to_seconds(frame.stamp - last), 0.040, 0.010) << i;
        EXPECT_LE(frame.stamp, now());
        EXPECT_LT(now() - frame.stamp, 40ms);
        last = frame.stamp;
        EXPECT_TRUE(video.give_back());
    }
    EXPECT_NEAR(to_seconds(now() - begin), 0.8, 0.1);
    EXPECT_EQ(video.counters(), (Counters{.frames = 25}));
}

/// Both forms show the same test picture: its bars, beginning with white.
TEST_F(Streaming, has_the_same_colours_in_both_forms) {
    control("Test Pattern", 0);
    control("Horizontal Movement", 3); // none
    std::vector<Colour> seen[2];
    for (const Format format : {Format::yuyv, Format::rgb24}) {
        CameraFacts facts = wanted;
        facts.format = format;
        open(facts);
        take_good(3);
        ASSERT_EQ(take(), Taken::frame);
        auto& picture = seen[static_cast<std::size_t>(format)];
        picture.resize(320 * 180);
        decode(frame, wanted.size, picture);
        EXPECT_TRUE(video.give_back());
    }
    for (std::size_t bar = 0; bar < 8; ++bar) {
        const std::size_t at = 150 * 320 + bar * 40 + 20; // below the text
        const auto near = [&](std::uint8_t Colour::* part) {
            EXPECT_NEAR(seen[0][at].*part, seen[1][at].*part, 6) << "bar " << bar;
        };
        near(&Colour::red);
        near(&Colour::green);
        near(&Colour::blue);
    }
    const Colour white = seen[1][150 * 320 + 20];
    EXPECT_GT(std::min({white.red, white.green, white.blue}), 180);
    EXPECT_NE(seen[1][150 * 320 + 20], seen[1][150 * 320 + 60]) << "the second bar has another colour";
}

TEST_F(Streaming, counts_the_frames_for_which_no_buffer_was_free) {
    open();
    take_good(1);
    std::this_thread::sleep_for(1s);
    take_good(5);
    EXPECT_GT(video.counters().lost, 15u) << "25 came, and 4 buffers held some";
    EXPECT_LT(video.counters().lost, 27u);
    video.begin_anew();
    const auto lost = video.counters().lost;
    take_good(2);
    EXPECT_EQ(video.counters().lost, lost);
}

TEST_F(Streaming, counts_the_frames_that_its_wire_dropped) {
    open();
    control("Percentage of Dropped Buffers", 50);
    take_good(20);
    control("Percentage of Dropped Buffers", 0);
    EXPECT_GT(video.counters().lost, 5u);
    EXPECT_EQ(video.counters().flawed, 0u);
}

TEST_F(Streaming, refuses_a_frame_that_is_marked_as_flawed) {
    open();
    take_good(2);
    control("Inject V4L2_BUF_FLAG_ERROR", 1);
    take_good(6);
    EXPECT_EQ(video.counters(), (Counters{.frames = 8, .flawed = 1}));
}

TEST_F(Streaming, refuses_frames_with_a_time_of_the_future) {
    set_stamp(StampOf::end);
    open();
    for (const Time end = now() + 300ms; now() < end; std::this_thread::sleep_for(1ms))
        EXPECT_NE(video.take(frame, {}, now()), Taken::frame);
    EXPECT_GE(video.counters().flawed, 5u);
}

TEST_F(Streaming, refuses_old_frames_as_late) {
    open();
    std::this_thread::sleep_for(300ms);
    int late = 0;
    for (int i = 0; i < 3; ++i) late += video.take(frame, now() - 20ms, now()) == Taken::refused ? 1 : 0;
    EXPECT_EQ(late, 3);
    EXPECT_EQ(video.counters().late, 3u);
}

TEST_F(Streaming, is_refused_with_the_sizes_that_the_camera_offers) {
    CameraFacts other = wanted;
    other.size = {322, 180};
    EXPECT_EQ(
        refusal(other),
        "it does not offer 322 x 180 in yuyv, it offers 320 x 180, 640 x 360, 640 x 480, 1280 x 720, 1920 x "
        "1080, 3840 x 2160; write one of these as frames(...) in the board's row");
}

TEST_F(Streaming, is_refused_with_the_rates_that_the_camera_offers) {
    CameraFacts other = wanted;
    other.per_second = 27;
    const std::string said = refusal(other);
    EXPECT_TRUE(said.starts_with("it does not offer 27 frames per second in this size, it offers ")) << said;
    EXPECT_NE(said.find(" 25, 30"), std::string::npos) << said;
    EXPECT_TRUE(said.ends_with("; write one of these as the third number of frames(...) in the board's row"))
        << said;
}

TEST_F(Streaming, is_refused_with_an_exposure_that_the_camera_lacks) {
    CameraFacts other = wanted;
    other.exposure = 16ms;
    EXPECT_EQ(refusal(other), "it has no exposure that can be set; remove exposure(...) from the binding");
}

TEST_F(Streaming, is_refused_while_another_program_streams) {
    open();
    EXPECT_EQ(refusal(wanted),
              "it cannot be set to a format: Device or resource busy; end the program that uses it");
    take_good(2);
}

TEST_F(Streaming, allocates_nothing_while_it_runs) {
    open();
    const auto before = ::mallinfo2().uordblks;
    take_good(10);
    video.begin_anew();
    EXPECT_EQ(::mallinfo2().uordblks, before);
}

TEST_F(Streaming, can_be_opened_again) {
    for (int i = 0; i < 3; ++i) {
        open();
        take_good(2);
        EXPECT_EQ(video.counters(), (Counters{.frames = 2}));
    }
    video.close();
    EXPECT_EQ(video.take(frame, {}, now()), Taken::failed);
}

TEST_F(Streaming, fails_when_the_stream_breaks) {
    open();
    take_good(2);
    control("Inject Fatal Streaming Error", 1);
    EXPECT_EQ(take(), Taken::failed);
    EXPECT_GE(video.counters().failures, 1u);
}

TEST_F(Streaming, fails_and_rests_once_the_camera_is_unplugged) {
    open();
    os::Waiter waiter;
    ASSERT_TRUE(waiter.watch(video.wait_handle()));
    take_good(2);
    control("Disconnect", 1);
    EXPECT_EQ(take(), Taken::failed);
    int returns = 0;
    for (int i = 0; i < 50; ++i) {
        returns += waiter.wait(now() + 2ms) ? 1 : 0;
        EXPECT_EQ(video.take(frame, now() - 1s, now()), Taken::failed);
    }
    EXPECT_LE(returns, 1) << "its descriptor hangs up for ever";
    video.close();
    open(); // vivid is plugged in again when nobody uses it
    take_good(2);
}

} // namespace
} // namespace tappet::camera

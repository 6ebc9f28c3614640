// Lines of candump logs: we read our own lines and those of canplayer and candump, and refuse an invalid line
// at its faulty column.
#include "drivers/can/candump.hpp"
#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

namespace tappet::can {
namespace {

Frame any_frame(Random& random) {
    Frame frame;
    frame.extended = random.one_in(2);
    frame.id = static_cast<std::uint32_t>(random.next()) & (frame.extended ? 0x1FFF'FFFFu : 0x7FFu);
    frame.fd = random.one_in(2);
    frame.remote = !frame.fd && random.one_in(4);
    frame.bit_rate_switch = frame.fd && random.one_in(2);
    frame.error_state_indicator = frame.fd && random.one_in(2);
    frame.length =
        static_cast<std::uint8_t>(padded_length(static_cast<unsigned>(random.next() % (frame.fd ? 65 : 9))));
    for (std::size_t i = 0; !frame.remote && i < frame.length; ++i)
        frame.data[i] = static_cast<std::uint8_t>(random.next());
    frame.stamp = at_ns(static_cast<std::int64_t>(random.next() % 9'000'000'000'000'000) * 1000);
    return frame;
}

TEST(Candump, reads_what_it_writes) {
    Random random{1};
    for (int i = 0; i < 20'000; ++i) {
        const Frame frame = any_frame(random);
        ASSERT_TRUE(valid(frame));
        const Sentence line = candump::write(frame, "can0");
        const auto read = candump::read(line.view());
        ASSERT_TRUE(read) << line.view() << ": " << read.error().column << ": " << read.error().what;
        EXPECT_EQ(read->frame, frame) << line.view();
        EXPECT_EQ(read->interface, "can0");
        EXPECT_FALSE(read->is_error);
    }
}

TEST(Candump, reads_each_kind_of_line_from_can_utils) {
    struct {
        const char* line;
        std::uint32_t id;
        unsigned length;
        bool extended, remote, fd, switches, error;
        std::int64_t ns;
    } static constexpr cases[] = {
        {"(1700000000.123456) can0 123#DEADBEEF", 0x123, 4, false, false, false, false, false,
         1'700'000'000'123'456'000},
        {"(0000000001.000000001) vcan12 00000123#", 0x123, 0, true, false, false, false, false,
         1'000'000'001},
        {"(000.5) can0 7ff#R", 0x7FF, 0, false, true, false, false, false, 500'000'000},
        {"(1.0) can0 1FFFFFFF#R8", 0x1FFF'FFFF, 8, true, true, false, false, false, 1'000'000'000},
        {"(1.0) can0 123##1AA", 0x123, 1, false, false, true, true, false, 1'000'000'000},
        {"(1.0) can0 123##4aabbccddeeff001122334455", 0x123, 12, false, false, true, false, false,
         1'000'000'000},
        {"(1.0) can0 123#1122334455667788_F", 0x123, 8, false, false, false, false, false, 1'000'000'000},
        {"(1.0) can0 123#11 R", 0x123, 1, false, false, false, false, false, 1'000'000'000},
        {"(1.0) can0 20000040#0000000000000000", 0x40, 8, false, false, false, false, true, 1'000'000'000},
    };
    for (const auto& each : cases) {
        const auto read = candump::read(each.line);
        ASSERT_TRUE(read) << each.line << ": " << read.error().column << ": " << read.error().what;
        EXPECT_EQ(read->frame.id, each.id) << each.line;
        EXPECT_EQ(read->frame.length, each.length) << each.line;
        EXPECT_EQ(read->frame.extended, each.extended) << each.line;
        EXPECT_EQ(read->frame.remote, each.remote) << each.line;
        EXPECT_EQ(read->frame.fd, each.fd) << each.line;
        EXPECT_EQ(read->frame.bit_rate_switch, each.switches) << each.line;
        EXPECT_EQ(read->is_error, each.error) << each.line;
        EXPECT_EQ(to_ns(read->frame.stamp), each.ns) << each.line;
    }
}

TEST(Candump, refuses_an_invalid_line_at_the_faulty_column) {
    struct {
        const char* line;
        std::size_t column;
        const char* says;
    } static constexpr cases[] = {
        {"  can0  123   [2]  AA BB", 1, "record with candump -L"},
        {"(17a) can0 123#", 4, "')'"},
        {"(.5) can0 123#", 2, "a time is seconds"},
        {"(9000000001.0) can0 123#", 2, "more than"},
        {"(12345678901.0) can0 123#", 2, "a time is seconds"},
        {"(1.0000000001) can0 123#", 14, "one to nine digits"},
        {"(1.) can0 123#", 4, "one to nine digits"},
        {"(1.0)can0 123#", 6, "a blank and the interface"},
        {"(1.0)  123#", 7, "a blank and the interface"},
        {"(1.0) can0", 11, "a blank and the frame"},
        {"(1.0) can0 12#AA", 12, "3 hexadecimal digits"},
        {"(1.0) can0 800#AA", 12, "up to 7FF"},
        {"(1.0) can0 40000000#AA", 12, "8 up to 1FFFFFFF"},
        {"(1.0) can0 1234567890#AA", 12, "3 hexadecimal digits"},
        {"(1.0) can0 123", 15, "# or"},
        {"(1.0) can0 123#A", 17, "cut off"},
        {"(1.0) can0 123#112233445566778899", 32, "CAN FD is written with ##"},
        {"(1.0) can0 123#11.22", 18, "expected nothing after"},
        {"(1.0) can0 123#R9", 17, "expected nothing after"},
        {"(1.0) can0 123#1122334455667788_8", 33, "length code"},
        {"(1.0) can0 123##", 17, "a digit of flags"},
        {"(1.0) can0 123##8AA", 17, "a digit of flags"},
        {"(1.0) can0 123##1112233445566778899", 18, "no frame of this length"},
        {"(1.0) can0 123##0R", 18, "expected nothing after"},
        {"", 1, "begins with its time"},
    };
    for (const auto& each : cases) {
        const auto read = candump::read(each.line);
        ASSERT_FALSE(read) << each.line;
        EXPECT_EQ(read.error().column, each.column) << each.line << ": " << read.error().what;
        EXPECT_NE(read.error().what.find(each.says), std::string_view::npos)
            << each.line << ": " << read.error().what;
    }
    EXPECT_TRUE(candump::read_seconds("12.5"));
    EXPECT_FALSE(candump::read_seconds("12.5s"));
}

TEST(Candump, rounds_times_up_to_the_next_microsecond) {
    EXPECT_EQ(candump::write({.stamp = at_ns(1'999'999'001)}, "can0").view(),
              "(0000000002.000000) can0 000#");
    EXPECT_EQ(candump::write({.stamp = at_ns(1'999'999'000)}, "can0").view(),
              "(0000000001.999999) can0 000#");
}

TEST(Candump, writes_only_interface_names_valid_on_linux) {
    EXPECT_EQ(candump::write({}, "axis of the can bus").view(), "(0000000000.000000) axis_of_the_can 000#");
}

// python3-can reads our lines and writes its own, which we read.
TEST(Candump, is_compatible_with_python_can) {
    const std::filesystem::path folder =
        std::filesystem::path{testing::TempDir()} / ("candump." + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    Random random{2};
    std::vector<Frame> frames;
    {
        std::ofstream log{folder / "ours.log"};
        for (int i = 0; i < 500; ++i) {
            Frame frame = any_frame(random);
            frame.error_state_indicator = false; // python-can's writer forgets it
            if (frame.remote) frame.length = 0;  // and this
            frame.stamp = Time{i * 1ms};         // it counts in doubles
            frames.push_back(frame);
            log << candump::write(frame, "can0").view() << '\n';
        }
    }
    const int code = std::system(("/usr/bin/python3 -W ignore " TAPPET_CANDUMP_ORACLE " " +
                                  (folder / "ours.log").string() + " " + (folder / "theirs.log").string())
                                     .c_str());
    ASSERT_EQ(code, 0) << "is python3-can installed? ci/setup does it";
    std::ifstream log{folder / "theirs.log"};
    std::size_t n = 0;
    for (std::string line; std::getline(log, line); ++n) {
        const auto read = candump::read(line);
        ASSERT_TRUE(read) << line << ": " << read.error().column << ": " << read.error().what;
        ASSERT_LT(n, frames.size());
        EXPECT_EQ(read->frame, frames[n]) << line;
    }
    EXPECT_EQ(n, frames.size());
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace tappet::can

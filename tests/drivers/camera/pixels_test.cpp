// Pixels of a camera as colours: corners of ITU-R BT.601, and padded rows.
#include "drivers/camera/pixels.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tappet::camera {
namespace {

std::vector<std::byte> bytes(std::initializer_list<int> values) {
    std::vector<std::byte> made;
    for (const int each : values) made.push_back(static_cast<std::byte>(each));
    return made;
}

TEST(Pixels, of_yuyv_have_the_colours_of_the_standard) {
    // Two pixels share their chroma: black and white, then red twice, then blue twice.
    const auto row = bytes({16, 128, 235, 128, 81, 90, 81, 240, 41, 240, 41, 110});
    std::array<Colour, 6> got{};
    decode({row, Format::yuyv, row.size(), {}}, {6, 1}, got);
    EXPECT_EQ(got[0], (Colour{0, 0, 0}));
    EXPECT_EQ(got[1], (Colour{255, 255, 255}));
    for (const std::size_t i : {2u, 3u}) EXPECT_EQ(got[i], (Colour{255, 0, 0})) << i;
    for (const std::size_t i : {4u, 5u}) EXPECT_EQ(got[i], (Colour{0, 0, 255})) << i;
}

TEST(Pixels, beyond_the_range_are_clamped) {
    const auto row = bytes({255, 255, 0, 255});
    std::array<Colour, 2> got{};
    decode({row, Format::yuyv, row.size(), {}}, {2, 1}, got);
    EXPECT_EQ(got[0].red, 255);
    EXPECT_EQ(got[0].blue, 255);
    EXPECT_EQ(got[1].green, 0);
}

TEST(Pixels, of_padded_rows_leave_the_padding_out) {
    const auto frame = bytes({1, 2, 3, 4, 5, 6, 99, 99, 7, 8, 9, 10, 11, 12});
    std::array<Colour, 4> got{};
    decode({frame, Format::rgb24, 8, {}}, {2, 2}, got);
    EXPECT_EQ(got, (std::array<Colour, 4>{{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}}}));
}

} // namespace
} // namespace tappet::camera

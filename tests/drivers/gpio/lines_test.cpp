// Opening GPIO lines that do not exist: each refusal names the place, the fault and the cure. The rest is
// tested on the bench.
#include "drivers/gpio/lines.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace tappet::gpio {
namespace {

constexpr std::array two{Line{.name = "a", .offset = 0}, Line{.name = "b", .offset = 1}};

std::string refusal(std::string_view chip, std::span<const Line> lines = two) {
    Lines device;
    const auto opened = device.open({.chip = chip, .lines = lines});
    EXPECT_FALSE(opened);
    EXPECT_EQ(device.wait_handle(), -1);
    return opened ? "" : std::string{opened.error().view()};
}

TEST(Lines, refuse_a_chip_that_does_not_exist) {
    EXPECT_EQ(refusal("/dev/gpiochip77"),
              "GPIO chip \"/dev/gpiochip77\" cannot be opened: No such file or directory; load its driver "
              "or name another in the board (gpiodetect lists them)");
    EXPECT_EQ(refusal("no-such-label"), "no GPIO chip is labelled \"no-such-label\": load its driver or name "
                                        "another in the board (gpiodetect lists them)");
}

TEST(Lines, refuse_a_path_that_is_not_a_chip) {
    EXPECT_NE(refusal("/dev/null").find("cannot be opened"), std::string::npos);
}

TEST(Lines, refuse_a_single_line) {
    EXPECT_NE(refusal("/dev/gpiochip0", std::span{two}.first(1)).find("two lines"), std::string::npos);
}

TEST(Lines, do_nothing_while_they_are_closed) {
    Lines device;
    std::array<Edge, 4> edges{};
    EXPECT_EQ(device.read_edges(edges).count, 0u);
    EXPECT_FALSE(device.levels().known);
    EXPECT_FALSE(device.write(1, 1));
}

} // namespace
} // namespace tappet::gpio

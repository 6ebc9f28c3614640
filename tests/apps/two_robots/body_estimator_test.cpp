// Packets of LEDs become the pose of a body, from any four visible LEDs at any pose; foreign packets are
// refused.
#include "apps/two_robots/tool/body_estimator.hpp"
#include "kernel/base/random.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace two_robots {
namespace {

Leds seen_of(const BodyFrame& body, std::uint8_t seen) {
    Leds leds{.cycle = 9, .seen = seen};
    for (std::size_t i = 0; i < led_count; ++i) {
        const auto& [x, y, z] = leds_on_body[i];
        const motion::Point<Base> place = body * motion::Point<Body>{{x, y, z}};
        leds.at[i] = {place.at.x(), place.at.y(), place.at.z()};
    }
    return leds;
}

TEST(Body, is_found_from_any_leds_that_are_seen) {
    Random random{3};
    for (int i = 0; i < 500; ++i) {
        BodyFrame body;
        const double x = random.unit(), y = random.unit(), z = random.unit();
        body.rotation = motion::rotation_about(0.8 * Eigen::Vector3d{x, y, z});
        body.position << 1 - x, z, 2 * y;
        const auto hidden = static_cast<unsigned>(random.below(6)),
                   too = static_cast<unsigned>(random.below(6));
        BodyFrame found;
        ASSERT_TRUE(fit_body(
            seen_of(body, static_cast<std::uint8_t>(0b111111U & ~(1U << hidden | 1U << too))), found));
        EXPECT_LT((found.position - body.position).norm(), 1e-9);
        EXPECT_LT((found.rotation - body.rotation).norm(), 1e-9);
    }
}

TEST(Body, is_not_known_from_two_leds) {
    BodyFrame found;
    EXPECT_FALSE(fit_body(seen_of({}, 0b000011), found));
    EXPECT_FALSE(fit_body(seen_of({}, 0), found));
}

TEST(Packet, is_read_as_it_was_written) {
    const Leds leds = seen_of({}, 0b110111);
    Leds read;
    ASSERT_TRUE(led_packet::read(led_packet::write(leds, false), read));
    EXPECT_EQ(read.seen, leds.seen);
    EXPECT_EQ(read.cycle, 9);
    EXPECT_EQ(read.at[5], leds.at[5]);
}

TEST(Packet, is_refused_when_truncated_invalid_or_of_another_body) {
    Leds read;
    const auto good = led_packet::write(seen_of({}, 0b111111), false);
    EXPECT_FALSE(led_packet::read(led_packet::write(seen_of({}, 0b111111), true), read))
        << "it says so itself";
    for (std::size_t size = 0; size < good.size(); ++size)
        EXPECT_FALSE(led_packet::read(std::span{good}.first(size), read));
    for (const std::size_t place : {0U, 2U, 8U, 9U, 13U}) { // length, type, invalid, body, how many
        auto bad = good;
        bad[place] ^= std::byte{1};
        EXPECT_FALSE(led_packet::read(bad, read)) << "at " << place;
    }
}

TEST(Packet, hides_leds_with_impossible_positions) {
    for (const double place :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200, -10.1}) {
        Leds leds = seen_of({}, 0b111111), read;
        leds.at[2][1] = place;
        ASSERT_TRUE(led_packet::read(led_packet::write(leds, false), read));
        EXPECT_EQ(read.seen, 0b111011) << place;
    }
}

TEST(Packet, may_contain_any_bytes) {
    Random random{5};
    for (int i = 0; i < 20000; ++i) {
        std::array<std::byte, led_packet::most> bytes = led_packet::write(seen_of({}, 0b111111), false);
        for (int k = 0; k < 3; ++k)
            bytes[random.below(bytes.size())] = static_cast<std::byte>(random.below(256));
        Leds read;
        BodyFrame body;
        if (led_packet::read(bytes, read)) static_cast<void>(fit_body(read, body));
    }
}

} // namespace
} // namespace two_robots

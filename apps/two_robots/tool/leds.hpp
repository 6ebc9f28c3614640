// The LEDs on the body's chest as a 3D camera measures them, and the camera's packets.
#pragma once

#include "kernel/base/fixed_matrix.hpp"
#include "kernel/base/type_tag.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace two_robots {

inline constexpr std::size_t led_count = 6;

/// Places in the body's frame, m: around the hole, not in one plane.
inline constexpr std::array<std::array<double, 3>, led_count> leds_on_body{{{0.10, 0.00, 0.00},
                                                                            {0.05, 0.09, 0.02},
                                                                            {-0.05, 0.09, 0.00},
                                                                            {-0.10, 0.00, 0.02},
                                                                            {-0.05, -0.09, 0.00},
                                                                            {0.05, -0.09, 0.02}}};

/// One exposure: places in the base of the robot that operates, m.
struct Leds {
    std::array<std::array<double, 3>, led_count> at{};
    std::uint16_t cycle = 0; ///< of the camera
    std::uint8_t seen = 0;   ///< one bit for each LED
};

/// A packet of the camera, little-endian: u16 length, type, sequence, reply; u8 invalid; u16 body, cycle,
/// number of LEDs; three doubles for each LED, not-a-number for a hidden one.
namespace led_packet {

inline constexpr std::uint16_t type = 345, body = 122;
inline constexpr std::size_t head = 4 * 2 + 1 + 3 * 2;
inline constexpr std::size_t most = head + led_count * 3 * sizeof(double);
inline constexpr double reach = 10.0; ///< m: farther places are invalid; filters would remember them

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

template <class T>
T number_at(std::span<const std::byte> packet, std::size_t place) noexcept TAPPET_REALTIME {
    T number;
    std::memcpy(&number, packet.data() + place, sizeof number);
    return number;
}
template <class T>
void put_at(std::span<std::byte> packet, std::size_t place, T number) noexcept TAPPET_REALTIME {
    std::memcpy(packet.data() + place, &number, sizeof number);
}

/// Reads a packet. Returns false when it is not of this camera and body, or when it is marked invalid.
[[nodiscard]] inline bool read(std::span<const std::byte> packet, Leds& leds) noexcept TAPPET_REALTIME {
    if (packet.size() != most || number_at<std::uint16_t>(packet, 0) != most ||
        number_at<std::uint16_t>(packet, 2) != type || number_at<std::uint8_t>(packet, 8) != 0 ||
        number_at<std::uint16_t>(packet, 9) != body || number_at<std::uint16_t>(packet, 13) != led_count)
        return false;
    leds = {.cycle = number_at<std::uint16_t>(packet, 11)};
    for (std::size_t i = 0; i < led_count; ++i) {
        bool is_seen = true;
        for (std::size_t axis = 0; axis < 3; ++axis)
            is_seen &= std::abs(leds.at[i][axis] = number_at<double>(
                                    packet, head + (3 * i + axis) * sizeof(double))) <= reach;
        if (is_seen) leds.seen = static_cast<std::uint8_t>(leds.seen | 1U << i);
    }
    return true;
}

inline std::array<std::byte, most> write(const Leds& leds, bool invalid) noexcept TAPPET_REALTIME {
    std::array<std::byte, most> packet{};
    put_at<std::uint16_t>(packet, 0, most);
    put_at<std::uint16_t>(packet, 2, type);
    put_at<std::uint16_t>(packet, 4, leds.cycle);
    put_at<std::uint8_t>(packet, 8, invalid ? 1 : 0);
    put_at<std::uint16_t>(packet, 9, body);
    put_at<std::uint16_t>(packet, 11, leds.cycle);
    put_at<std::uint16_t>(packet, 13, led_count);
    for (std::size_t i = 0; i < led_count; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            put_at<double>(packet, head + (3 * i + axis) * sizeof(double),
                           (leds.seen >> i & 1U) != 0 ? leds.at[i][axis]
                                                      : std::numeric_limits<double>::quiet_NaN());
    return packet;
}

} // namespace led_packet

} // namespace two_robots

namespace tappet {

template <>
inline constexpr auto fields_of<two_robots::Leds> =
    fields(field<&two_robots::Leds::cycle>("cycle"), field<&two_robots::Leds::seen>("seen"));

} // namespace tappet

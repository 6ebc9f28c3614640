// One signal inside a CAN frame: where its bits lie and what they mean, as the DBC format numbers them.
#pragma once

#include "kernel/base/realtime.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>

namespace tappet::can {

enum class Order : std::uint8_t {
    intel,    ///< DBC @1: `start` is the least significant bit, higher bits follow upwards
    motorola, ///< DBC @0: `start` is the most significant bit; bit 0 of a byte is followed by bit 7 of the
              ///< next
};

enum class Kind : std::uint8_t { unsigned_integer, signed_integer, float32, float64 };

/// physical = raw * factor + offset; the sign belongs to the raw value.
struct Signal {
    std::string_view name{};
    std::uint16_t start = 0; ///< in DBC's numbering: bit 8 * byte + position
    std::uint8_t bits = 0;
    Order order = Order::intel;
    Kind kind = Kind::unsigned_integer;
    double factor = 1;
    double offset = 0;
    std::string_view unit{};
    double safe_value = 0; ///< of what is transmitted: sent when the machine's process is no more
    bool says_safe = false;

    // Written as a row: signal("speed", 16, 32).as_signed().times(0.1).in("rpm").safe(0)
    constexpr Signal as_signed() const noexcept {
        Signal copy = *this;
        copy.kind = Kind::signed_integer;
        return copy;
    }
    constexpr Signal as_float() const noexcept {
        Signal copy = *this;
        copy.kind = bits == 64 ? Kind::float64 : Kind::float32;
        return copy;
    }
    constexpr Signal big_endian() const noexcept {
        Signal copy = *this;
        copy.order = Order::motorola;
        return copy;
    }
    constexpr Signal times(double new_factor) const noexcept {
        Signal copy = *this;
        copy.factor = new_factor;
        return copy;
    }
    constexpr Signal plus(double new_offset) const noexcept {
        Signal copy = *this;
        copy.offset = new_offset;
        return copy;
    }
    constexpr Signal in(std::string_view new_unit) const noexcept {
        Signal copy = *this;
        copy.unit = new_unit;
        return copy;
    }
    constexpr Signal safe(double value) const noexcept {
        Signal copy = *this;
        copy.safe_value = value;
        copy.says_safe = true;
        return copy;
    }
};

constexpr Signal signal(std::string_view name, std::uint16_t start, std::uint8_t bits) noexcept {
    Signal s;
    s.name = name;
    s.start = start;
    s.bits = bits;
    return s;
}

using Payload = std::array<std::uint8_t, 8>;

/// The place of the signal's i-th bit, counted from the least significant, as 8 * byte + position. Real-time.
/// Beyond 63 when it lies outside a frame.
constexpr unsigned bit_place(const Signal& s, unsigned i) noexcept TAPPET_REALTIME {
    if (s.order == Order::intel) return s.start + i;
    // Read a byte from its left end and the bits of a Motorola signal follow each other: count in that
    // direction.
    const unsigned from_left = 8u * (s.start / 8u) + (7u - s.start % 8u) + (s.bits - 1u - i);
    return 8u * (from_left / 8u) + (7u - from_left % 8u);
}

namespace detail {
/// Where a signal lies in the eight bytes read as one number: the first byte the lowest, of a Motorola signal
/// the highest. Its bits follow each other there.
constexpr unsigned shift_of(const Signal& s) noexcept TAPPET_REALTIME {
    if (s.order == Order::intel) return s.start;
    return 64u - (8u * (s.start / 8u) + (7u - s.start % 8u)) - s.bits;
}
constexpr std::uint64_t in_order(std::uint64_t bytes, const Signal& s) noexcept TAPPET_REALTIME {
    constexpr bool little = std::endian::native == std::endian::little;
    return little == (s.order == Order::intel) ? bytes : std::byteswap(bytes);
}
constexpr std::uint64_t mask_of(const Signal& s) noexcept TAPPET_REALTIME {
    return s.bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << s.bits) - 1;
}
} // namespace detail

/// The raw bits, as many as the signal has. Real-time; the signal lies inside the frame.
constexpr std::uint64_t extract(const Payload& data, const Signal& s) noexcept TAPPET_REALTIME {
    const std::uint64_t whole = detail::in_order(std::bit_cast<std::uint64_t>(data), s);
    return whole >> detail::shift_of(s) & detail::mask_of(s);
}

constexpr void insert(Payload& data, const Signal& s, std::uint64_t raw) noexcept TAPPET_REALTIME {
    const std::uint64_t mask = detail::mask_of(s);
    const std::uint64_t whole = detail::in_order(std::bit_cast<std::uint64_t>(data), s);
    const unsigned shift = detail::shift_of(s);
    data = std::bit_cast<Payload>(detail::in_order((whole & ~(mask << shift)) | (raw & mask) << shift, s));
}

/// Raw bits as a whole number, sign extended. Real-time.
constexpr std::int64_t to_integer(const Signal& s, std::uint64_t raw) noexcept TAPPET_REALTIME {
    if (s.kind != Kind::signed_integer || s.bits >= 64) return static_cast<std::int64_t>(raw);
    const std::uint64_t sign = std::uint64_t{1} << (s.bits - 1u);
    return static_cast<std::int64_t>((raw ^ sign) - sign);
}

constexpr double to_physical(const Signal& s, std::uint64_t raw) noexcept TAPPET_REALTIME {
    double number = 0;
    switch (s.kind) {
    case Kind::unsigned_integer: number = static_cast<double>(raw); break;
    case Kind::signed_integer: number = static_cast<double>(to_integer(s, raw)); break;
    case Kind::float32:
        number = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
        break;
    case Kind::float64: number = std::bit_cast<double>(raw); break;
    }
    return number * s.factor + s.offset;
}

struct Raw {
    std::uint64_t bits = 0;
    bool saturated =
        false; ///< the value was out of range, and its nearest end was taken: never a wrapped value
    bool refused = false; ///< not a number
};

/// Real-time. Rounds to the nearest, halves away from zero.
constexpr Raw to_raw(const Signal& s, double physical) noexcept TAPPET_REALTIME {
    const double number = (physical - s.offset) / s.factor;
    if (number != number) return {.refused = true};
    if (s.kind == Kind::float64) return {.bits = std::bit_cast<std::uint64_t>(number)};
    if (s.kind == Kind::float32) {
        constexpr double most = 3.4028234663852886e38;
        const double kept = number > most ? most : number < -most ? -most : number;
        return {.bits = std::bit_cast<std::uint32_t>(static_cast<float>(kept)), .saturated = kept != number};
    }
    const std::uint64_t all = s.bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << s.bits) - 1;
    const bool is_signed = s.kind == Kind::signed_integer;
    const std::uint64_t high = is_signed ? all >> 1 : all;
    const std::uint64_t low = is_signed ? ~high : 0;                              // two's complement
    const double limit = high == 0 ? 1.0 : static_cast<double>(high / 2 + 1) * 2; // one above `high`, exactly
    // Above 2^52 every double is whole, and half would be rounded.
    const double half = number < 4503599627370496.0 && number > -4503599627370496.0 ? 0.5 : 0.0;
    if (number >= 0) {
        if (number + half >= limit) return {.bits = high, .saturated = true};
        return {.bits = static_cast<std::uint64_t>(number + half)};
    }
    if (is_signed && number - half > -limit - 1.0) // truncation brings it to -limit at least
        return {.bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(number - half)) & all};
    if (is_signed) return {.bits = low & all, .saturated = number < -limit};
    return {.bits = 0, .saturated = number - half <= -1.0};
}

} // namespace tappet::can

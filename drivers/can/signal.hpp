// One signal inside a CAN frame: the place of its bits and their meaning, numbered as in the DBC format.
#pragma once

#include "drivers/can/frame.hpp"
#include "drivers/map/rows.hpp"
#include "kernel/base/bounded.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace tappet::can {

enum class Order : std::uint8_t {
    intel,    ///< DBC @1: `start` is the least significant bit, higher bits follow upwards
    motorola, ///< DBC @0: `start` is the most significant bit; bit 0 of a byte is followed by bit 7 of the
              ///< next
};

enum class Kind : std::uint8_t { unsigned_integer, signed_integer, float32, float64 };

/// Values of a multiplexor, both ends included.
struct Selection {
    std::uint32_t from = 0;
    std::uint32_t to = 0;

    constexpr Selection() noexcept = default;
    // NOLINTNEXTLINE: one value is a selection
    constexpr Selection(std::integral auto value) noexcept : Selection{value, value} {}
    constexpr Selection(std::integral auto first, std::integral auto last) noexcept
        : from{static_cast<std::uint32_t>(first)}, to{static_cast<std::uint32_t>(last)} {}
};
/// when("page", 1, between(4, 7))
constexpr Selection between(std::uint32_t first, std::uint32_t last) noexcept { return {first, last}; }

/// The name of a raw value, before factor and offset.
struct ValueName {
    std::int64_t value = 0;
    std::string_view name{};
};

/// physical = raw * factor + offset; the sign belongs to the raw value.
struct Signal : ScaledValue<Signal> {
    static constexpr std::size_t most_selections = 8;

    std::uint16_t start = 0; ///< in DBC's numbering: bit 8 * byte + position
    std::uint8_t bits = 0;
    Order order = Order::intel;
    Kind kind = Kind::unsigned_integer;
    std::string_view safe_name{}; ///< instead of `safe_value`; the map looks it up in `names`
    bool is_bits = false;         ///< not a number: a control word, a set of switches
    bool has_range = false;       ///< `least` and `most` limit the physical values that are sent
    double least = 0;
    double most = 0;
    /// The signal of the same frame whose value selects this one; empty: it is in every frame.
    std::string_view multiplexor{};
    Bounded<Selection, most_selections> selections{};
    std::span<const ValueName> names{}; ///< of some of its values
    std::string_view in_file{};         ///< its name in its DBC file, when the row gives it another
    bool despite_file = false;          ///< the row is believed instead of its DBC file

    // Written as a row: signal("speed", 16, 32).as_signed().times(0.1).in("rpm").safe(0)
    constexpr Signal as_signed() const noexcept {
        return copy_with(*this, &Signal::kind, Kind::signed_integer);
    }
    /// For an integer that is a set of bits: bits beyond the width are cut. Other integers saturate.
    constexpr Signal as_bits() const noexcept { return copy_with(*this, &Signal::is_bits, true); }
    constexpr Signal as_float() const noexcept {
        return copy_with(*this, &Signal::kind, bits == 64 ? Kind::float64 : Kind::float32);
    }
    constexpr Signal big_endian() const noexcept { return copy_with(*this, &Signal::order, Order::motorola); }
    constexpr Signal safe(double value) const noexcept {
        return copy_with(ScaledValue::safe(value), &Signal::safe_name, std::string_view{});
    }
    /// Takes the safe value with this name in its file or in the list of named(): safe("Neutral").
    constexpr Signal safe(std::string_view value_name) const noexcept {
        return copy_with(*this, &Signal::safe_name, value_name, &Signal::says_safe, true);
    }
    /// Limits what is sent to this range, except values that have a name.
    constexpr Signal range(double new_least, double new_most) const noexcept {
        return copy_with(*this, &Signal::least, new_least, &Signal::most, new_most, &Signal::has_range, true);
    }
    /// In a frame only while its signal `of` has one of these values: when("page", 1, between(4, 7)).
    template <std::convertible_to<Selection>... S>
        requires(sizeof...(S) > 0 && sizeof...(S) <= most_selections)
    constexpr Signal when(std::string_view of, const S&... values) const noexcept {
        return copy_with(*this, &Signal::multiplexor, of, &Signal::selections,
                         Bounded<Selection, most_selections>{{Selection(values)...}, sizeof...(S)});
    }
    /// Names its values by a constant list that outlives the map.
    constexpr Signal named(std::span<const ValueName> values) const noexcept {
        return copy_with(*this, &Signal::names, values);
    }
    /// Gives its facet this name instead of its name in the file.
    constexpr Signal called(std::string_view facet) const noexcept {
        return copy_with(*this, &Signal::in_file, name, &Signal::name, facet);
    }

    [[nodiscard]] constexpr bool is_selected_by(std::uint64_t raw) const noexcept TAPPET_REALTIME {
        for (const Selection& each : selections)
            if (raw >= each.from && raw <= each.to) return true;
        return false;
    }
    [[nodiscard]] constexpr bool has_name(std::int64_t value) const noexcept TAPPET_REALTIME {
        for (const ValueName& each : names)
            if (each.value == value) return true;
        return false;
    }
};

constexpr Signal signal(std::string_view name, std::uint16_t start, std::uint8_t bits) noexcept {
    return {{{name}}, start, bits};
}

/// A signal whose place and meaning come from a DBC file.
constexpr Signal signal(std::string_view name) noexcept { return signal(name, 0, 0); }

/// A signal is a whole number unless a factor, an offset or a float makes it a physical value.
constexpr bool is_integer(const Signal& s) noexcept {
    return s.factor == 1 && s.offset == 0 &&
           (s.kind == Kind::unsigned_integer || s.kind == Kind::signed_integer);
}

/// The place of the signal's i-th bit, counted from the least significant, as 8 * byte + position. Real-time.
constexpr unsigned bit_place(const Signal& s, unsigned i) noexcept TAPPET_REALTIME {
    if (s.order == Order::intel) return s.start + i;
    // The bits of a Motorola signal are consecutive when each byte is read from its left end: count in that
    // direction.
    const unsigned from_left = 8u * (s.start / 8u) + (7u - s.start % 8u) + (s.bits - 1u - i);
    return 8u * (from_left / 8u) + (7u - from_left % 8u);
}

/// The place of a signal in eight bytes of its frame that are read as one number, in which its bits are
/// consecutive. The first byte is the lowest, or the highest for a Motorola signal. A signal of more than 57
/// bits may continue in a ninth byte.
struct Place {
    std::uint8_t byte = 0;  ///< the first of the eight, which end within the longest frame
    std::uint8_t shift = 0; ///< position of its lowest bit in the eight
    std::uint8_t over = 0;  ///< bits in the ninth: the highest, or a Motorola signal's lowest
    std::uint8_t bits = 1;
    Order order = Order::intel;
};
/// Returns the place of a signal that lies inside its frame.
constexpr Place place_of(const Signal& s) noexcept TAPPET_REALTIME {
    constexpr unsigned last = sizeof(Payload) - 8;
    const bool is_intel = s.order == Order::intel;
    // A Motorola signal's bits are counted from the left end of each byte.
    const unsigned at = is_intel ? s.start : s.start ^ 7u;
    const unsigned byte = std::min(at / 8u, last);
    const unsigned from = at - 8u * byte, end = from + s.bits;
    const unsigned over = end > 64u ? end - 64u : 0u;
    return {static_cast<std::uint8_t>(byte), static_cast<std::uint8_t>(is_intel ? from : 64u + over - end),
            static_cast<std::uint8_t>(over), s.bits, s.order};
}

namespace detail {
constexpr std::uint64_t in_order(std::uint64_t bytes, Order order) noexcept TAPPET_REALTIME {
    constexpr bool little = std::endian::native == std::endian::little;
    return little == (order == Order::intel) ? bytes : std::byteswap(bytes);
}
constexpr std::uint64_t mask_of(unsigned bits) noexcept TAPPET_REALTIME {
    return ~std::uint64_t{0} >> (64u - bits);
}
constexpr std::uint64_t mask_of(const Signal& s) noexcept TAPPET_REALTIME {
    return s.bits == 0 ? 0 : mask_of(s.bits);
}
constexpr std::uint64_t eight_bytes(const std::uint8_t* from) noexcept TAPPET_REALTIME {
    std::array<std::uint8_t, 8> bytes{};
    if consteval {
        for (std::size_t i = 0; i < 8; ++i) bytes[i] = from[i];
    } else {
        std::memcpy(bytes.data(), from, 8);
    }
    return std::bit_cast<std::uint64_t>(bytes);
}
constexpr void put_eight_bytes(std::uint64_t number, std::uint8_t* to) noexcept TAPPET_REALTIME {
    const auto bytes = std::bit_cast<std::array<std::uint8_t, 8>>(number);
    if consteval {
        for (std::size_t i = 0; i < 8; ++i) to[i] = bytes[i];
    } else {
        std::memcpy(to, bytes.data(), 8);
    }
}
} // namespace detail

/// Returns the raw bits at this place. Real-time.
constexpr std::uint64_t extract(const Payload& data, Place at) noexcept TAPPET_REALTIME {
    const std::uint64_t whole = detail::in_order(detail::eight_bytes(&data[at.byte]), at.order);
    const std::uint64_t mask = detail::mask_of(at.bits);
    if (at.over == 0) [[likely]]
        return whole >> at.shift & mask;
    const std::uint64_t ninth = data[at.byte + 8u];
    return (at.order == Order::intel ? whole >> at.shift | ninth << (64u - at.shift)
                                     : whole << at.over | ninth >> (8u - at.over)) &
           mask;
}
/// Returns the raw bits of a signal that lies inside the frame. Real-time.
constexpr std::uint64_t extract(const Payload& data, const Signal& s) noexcept TAPPET_REALTIME {
    return extract(data, place_of(s));
}

/// Writes raw bits into the frame; bits beyond the signal's width are cut. Real-time.
constexpr void insert(Payload& data, Place at, std::uint64_t raw) noexcept TAPPET_REALTIME {
    std::uint64_t mask = detail::mask_of(at.bits);
    raw &= mask;
    if (at.over != 0) [[unlikely]] {
        const bool is_intel = at.order == Order::intel;
        const unsigned place = is_intel ? 0u : 8u - at.over;
        const unsigned those = (1u << at.over) - 1u;
        const auto set = static_cast<unsigned>(is_intel ? raw >> (64u - at.shift) : raw) & those;
        std::uint8_t& ninth = data[at.byte + 8u];
        ninth = static_cast<std::uint8_t>((ninth & ~(those << place)) | set << place);
        if (!is_intel) raw >>= at.over, mask >>= at.over;
    }
    const std::uint64_t whole = detail::in_order(detail::eight_bytes(&data[at.byte]), at.order);
    const std::uint64_t set = (whole & ~(mask << at.shift)) | raw << at.shift;
    detail::put_eight_bytes(detail::in_order(set, at.order), &data[at.byte]);
}
constexpr void insert(Payload& data, const Signal& s, std::uint64_t raw) noexcept TAPPET_REALTIME {
    insert(data, place_of(s), raw);
}

/// Returns raw bits as a whole number, sign extended. Real-time.
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
    bool saturated = false; ///< the value was out of range and became the nearest limit; it never wraps
    bool refused = false;   ///< not a number, or infinite
};

namespace detail {
constexpr Raw to_any_raw(const Signal& s, double physical) noexcept TAPPET_REALTIME {
    if (!is_number(physical)) return {.refused = true};
    const double number = (physical - s.offset) / s.factor; // infinite for a large one: the nearest limit
    if (s.kind == Kind::float64) {
        constexpr double most = 1.7976931348623157e308;
        const double kept = number > most ? most : number < -most ? -most : number;
        return {.bits = std::bit_cast<std::uint64_t>(kept), .saturated = kept != number};
    }
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
    // Above 2^52 every double is whole, and adding a half would round.
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
} // namespace detail

/// Returns the raw bits of a physical value, rounded to nearest, halves away from zero. Real-time.
constexpr Raw to_raw(const Signal& s, double physical) noexcept TAPPET_REALTIME {
    const Raw raw = detail::to_any_raw(s, physical);
    if (!s.has_range || (physical >= s.least && physical <= s.most) || raw.refused) return raw;
    if (!raw.saturated && s.has_name(to_integer(s, raw.bits))) return raw;
    return {.bits = detail::to_any_raw(s, physical < s.least ? s.least : s.most).bits, .saturated = true};
}

/// Returns the raw bits of an integer, for a signal without factor and offset. Saturates exactly; a set of
/// bits (as_bits) is cut to its width. Real-time.
constexpr Raw to_raw_integer(const Signal& s, std::int64_t value) noexcept TAPPET_REALTIME {
    const std::uint64_t mask = detail::mask_of(s);
    if (s.is_bits) return {.bits = static_cast<std::uint64_t>(value) & mask};
    if (s.has_range && s.bits < 64)
        if (const Raw raw = to_raw(s, static_cast<double>(value)); raw.saturated) return raw;
    const bool is_signed = s.kind == Kind::signed_integer;
    const auto most = static_cast<std::int64_t>((is_signed ? mask : mask & ~(std::uint64_t{1} << 63)) >>
                                                (is_signed ? 1 : 0));
    const std::int64_t least = is_signed ? -most - 1 : 0;
    const std::int64_t kept = std::clamp(value, least, most);
    return {.bits = static_cast<std::uint64_t>(kept) & mask, .saturated = kept != value};
}

/// Returns the end of a message about an unknown name: the nearest name, or else `otherwise`.
constexpr Sentence or_meant(const Nearest& nearest, std::string_view otherwise) noexcept {
    return nearest.best().empty() ? Sentence{otherwise}
                                  : Sentence{"; did you mean \"", nearest.best(), "\"?"};
}

/// Returns the first value with this name; null: none.
constexpr const ValueName* value_called(const Signal& s, std::string_view name) noexcept {
    for (const ValueName& each : s.names)
        if (each.name == name) return &each;
    return nullptr;
}
/// Returns the named value as its facet has it.
constexpr double physical_of(const Signal& s, const ValueName& value) noexcept {
    return static_cast<double>(value.value) * s.factor + s.offset;
}
/// Returns why a name does not identify a value.
constexpr Sentence name_fault(std::string_view frame, const Signal& s, std::string_view name) noexcept {
    const Sentence who{"signal \"", frame, ".", s.name, "\" has "};
    const ValueName* const value = value_called(s, name);
    Nearest nearest{name};
    for (const ValueName& each : s.names) {
        nearest.consider(each.name);
        if (each.name == name && &each != value)
            return Sentence(who, "two values \"", name, "\", ", value->value, " and ", each.value,
                            "; give them different names, by VAL_ or by .named(..)");
    }
    if (value != nullptr) return {};
    return Sentence{who, "no value \"", name, "\"",
                    or_meant(nearest, "; name it by VAL_ in its file, or by .named(..)")};
}

} // namespace tappet::can

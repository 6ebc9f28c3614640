// The encoding of a row's values on the wire: whole numbers of a given number of bits, or the value's own
// bytes. The sender packs several of them into one frame, bit after bit, little end first.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/base/whole_value.hpp"
#include "kernel/system/rows.hpp"

#include <cmath>
#include <cstring>

namespace tappet {

/// The encoded form of one value.
struct WireValue {
    std::uint16_t bits = 0;
    ValueKind kind = ValueKind::opaque; ///< boolean: one bit; opaque: the value's own bytes
    std::uint8_t bytes = 0;             ///< of the value in the machine
    bool is_signed = true;
    bool is_real = false;  ///< opaque, and a floating-point number
    bool has_time = false; ///< the time at which it was true follows
    double step = 1;
    TypeId type = nullptr; ///< of a value that crosses as it is
    constexpr bool operator==(const WireValue&) const = default;

    /// The bits in a frame: one for its validity, the value, and its time.
    [[nodiscard]] constexpr std::uint16_t bits_in_frame() const noexcept;
};

/// A time on the wire: the common time in these steps, modulo 2 to the power of time_bits.
inline constexpr std::int64_t time_step_ns = 10'000;
inline constexpr std::uint16_t time_bits = 16;
/// A value that is older on arrival is not valid; a quarter of the range is reserved for clock differences.
inline constexpr Duration oldest_told{(std::int64_t{1} << time_bits) * time_step_ns / 4 * 3};
/// A frame that waits longer in a driver or a controller has been given up.
inline constexpr Duration longest_under_way = 100ms;

constexpr std::uint16_t WireValue::bits_in_frame() const noexcept {
    return static_cast<std::uint16_t>(1 + bits + (has_time ? time_bits : 0));
}

/// Returns the encoding of a value or an argument list. Without one, `bits` is 0 and `fault` says why.
constexpr WireValue wire_value(TypeId type, const Encoding& encoding, Sentence& fault) {
    if (type->kind == ValueKind::arguments && type->elements.size() == 1) type = type->elements[0];
    WireValue value{.bits = static_cast<std::uint16_t>(8 * type->size),
                    .bytes = static_cast<std::uint8_t>(type->size),
                    .is_signed = encoding.is_signed,
                    .step = encoding.step};
    if (type->size > 56) {
        fault = Sentence{"a value of type ", type->name, " has ", type->size,
                         " bytes, more than a frame holds; send a part of it"};
        value.bits = 0;
    }
    if (encoding.bits == 0) {
        if (type->kind == ValueKind::boolean) value.kind = ValueKind::boolean, value.bits = 1;
        value.is_real = type->kind == ValueKind::real;
        if (value.kind == ValueKind::opaque) value.type = type;
        return value;
    }
    const bool is_number = (type->kind == ValueKind::integer || type->kind == ValueKind::natural ||
                            type->kind == ValueKind::real) &&
                           type->size >= 4;
    if (!is_number) {
        fault =
            Sentence{"a value of type ", type->name,
                     " is not a number of at least 4 bytes: remove in_bits(...), and it is sent as it is"};
        value.bits = 0;
    } else if (encoding.bits > 56 || !(encoding.step > 0 && tappet::is_number(encoding.step))) {
        fault = Sentence{"in_bits takes 1 to 56 bits and a finite step above 0"};
        value.bits = 0;
    } else {
        value.kind = type->kind;
        value.bits = encoding.bits;
    }
    return value;
}

namespace on_wire {

/// Returns `bits` bits of `from`, beginning at bit `at`; at most 56. Real-time, like all functions below.
constexpr std::uint64_t take_bits(std::span<const std::uint8_t> from, std::size_t at,
                                  std::size_t bits) noexcept TAPPET_REALTIME {
    std::uint64_t value = 0;
    for (std::size_t done = 0; done < bits;) { // the part in one byte at a time
        const std::size_t shift = (at + done) % 8, count = std::min(8 - shift, bits - done);
        const unsigned part = static_cast<unsigned>(from[(at + done) / 8]) >> shift & ((1u << count) - 1u);
        value |= std::uint64_t{part} << done;
        done += count;
    }
    return value;
}
constexpr void put_bits(std::span<std::uint8_t> into, std::size_t at, std::size_t bits,
                        std::uint64_t value) noexcept TAPPET_REALTIME {
    for (std::size_t done = 0; done < bits;) {
        const std::size_t shift = (at + done) % 8, count = std::min(8 - shift, bits - done);
        std::uint8_t& byte = into[(at + done) / 8];
        const unsigned mask = ((1u << count) - 1u) << shift;
        byte = static_cast<std::uint8_t>((byte & ~mask) |
                                         (static_cast<unsigned>(value >> done) << shift & mask));
        done += count;
    }
}

/// How a value was put into a frame: exactly, clamped to its range, or not at all because it is not a number.
enum class Told : std::uint8_t { well, beyond, no_number };

/// Computes the whole number nearest to value / step that the bits can hold.
inline Told to_steps(double value, const WireValue& as, std::int64_t& steps) noexcept TAPPET_REALTIME {
    if (!is_number(value)) return Told::no_number;
    const double wanted = value / as.step;
    const std::int64_t most = (std::int64_t{1} << (as.bits - (as.is_signed ? 1 : 0))) - 1;
    const std::int64_t least = as.is_signed ? -most - 1 : 0;
    if (wanted >= static_cast<double>(most) + 0.5) return steps = most, Told::beyond;
    if (wanted <= static_cast<double>(least) - 0.5) return steps = least, Told::beyond;
    steps = static_cast<std::int64_t>(std::floor(wanted + 0.5));
    return Told::well;
}

/// Puts a value into a frame at bit `at`, from the value's bytes in the machine.
inline Told tell(const std::byte* value, const WireValue& as, std::span<std::uint8_t> into,
                 std::size_t at) noexcept TAPPET_REALTIME {
    if (as.kind == ValueKind::boolean) {
        bool truth = false;
        std::memcpy(&truth, value, sizeof truth);
        put_bits(into, at, 1, truth ? 1 : 0);
        return Told::well;
    }
    if (as.kind == ValueKind::opaque) {
        if (as.is_real && !is_number(real_at(value, as.bytes))) return Told::no_number;
        for (std::size_t i = 0; i < as.bytes; ++i)
            put_bits(into, at + 8 * i, 8, std::to_integer<std::uint64_t>(value[i]));
        return Told::well;
    }
    std::int64_t steps = 0;
    Told told = Told::well;
    if (as.kind == ValueKind::real) {
        told = to_steps(real_at(value, as.bytes), as, steps);
    } else {
        std::int64_t whole = 0;
        if (as.bytes == 4 && as.kind == ValueKind::integer) {
            std::int32_t small = 0;
            std::memcpy(&small, value, sizeof small);
            whole = small;
        } else {
            std::memcpy(&whole, value, as.bytes);
        }
        const std::int64_t most = (std::int64_t{1} << (as.bits - (as.is_signed ? 1 : 0))) - 1;
        const std::int64_t least = as.is_signed ? -most - 1 : 0;
        if (as.step == 1) {
            steps = std::clamp(whole, least, most);
            told = steps == whole ? Told::well : Told::beyond;
        } else {
            told = to_steps(static_cast<double>(whole), as, steps);
        }
    }
    if (told != Told::no_number) put_bits(into, at, as.bits, static_cast<std::uint64_t>(steps));
    return told;
}

/// Encodes a time of the common clock.
constexpr std::uint64_t tell_time(Time common) noexcept TAPPET_REALTIME {
    return static_cast<std::uint64_t>(to_ns(common) / time_step_ns) & ((1u << time_bits) - 1);
}
/// Computes how long before `now` the time `told` was. A time that seems to be later, by no more than clocks
/// may differ, counts as now. False: the time is neither.
constexpr bool age_of_time(std::uint64_t told, Time now, Duration clocks_differ, Duration& age) noexcept
    TAPPET_REALTIME {
    constexpr std::int64_t turn = std::int64_t{1} << time_bits;
    const auto steps = static_cast<std::int64_t>((tell_time(now) - told) & (turn - 1));
    age = Duration{steps * time_step_ns};
    if (age <= oldest_told) return true;
    age = Duration::zero();
    return Duration{(turn - steps) * time_step_ns} <= clocks_differ + Duration{2 * time_step_ns};
}

/// Reads a value from a frame. False: it is not a number, or longer than its type.
inline bool hear(std::span<const std::uint8_t> from, std::size_t at, const WireValue& as,
                 std::byte* value) noexcept TAPPET_REALTIME {
    if (as.kind == ValueKind::boolean) {
        const bool truth = take_bits(from, at, 1) != 0;
        std::memcpy(value, &truth, sizeof truth);
        return true;
    }
    if (as.kind == ValueKind::opaque) {
        for (std::size_t i = 0; i < as.bytes; ++i)
            value[i] = static_cast<std::byte>(take_bits(from, at + 8 * i, 8));
        return is_whole(*as.type, value) && (!as.is_real || is_number(real_at(value, as.bytes)));
    }
    auto steps = static_cast<std::int64_t>(take_bits(from, at, as.bits));
    if (as.is_signed && (steps >> (as.bits - 1) & 1) != 0) steps -= std::int64_t{1} << as.bits;
    if (as.kind == ValueKind::real) {
        const double number = static_cast<double>(steps) * as.step;
        if (as.bytes == sizeof(float)) {
            const auto single = static_cast<float>(number);
            std::memcpy(value, &single, sizeof single);
        } else {
            std::memcpy(value, &number, sizeof number);
        }
        return true;
    }
    const std::int64_t whole =
        as.step == 1 ? steps
                     : static_cast<std::int64_t>(std::floor(static_cast<double>(steps) * as.step + 0.5));
    std::memcpy(value, &whole, as.bytes); // little end first, as in the machine
    return true;
}

} // namespace on_wire

} // namespace tappet

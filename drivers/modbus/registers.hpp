// One value in a Modbus server's tables: its words or bit, and their meaning.
#pragma once

#include "drivers/map/rows.hpp"
#include "kernel/base/number.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>

namespace tappet::modbus {

enum class Table : std::uint8_t { coils, discrete_inputs, input_registers, holding_registers };
constexpr bool holds_bits(Table table) noexcept {
    return table == Table::coils || table == Table::discrete_inputs;
}
constexpr bool writable(Table table) noexcept {
    return table == Table::coils || table == Table::holding_registers;
}
constexpr std::string_view name_of(Table table) noexcept {
    constexpr std::array<std::string_view, 4> names{"coils", "discrete inputs", "input registers",
                                                    "holding registers"};
    return names[static_cast<std::size_t>(table)];
}

/// Returns the function code of the client's requests (Modbus application protocol 1.1b3, section 6).
constexpr unsigned function_code(Table table, bool write) noexcept {
    if (write) return holds_bits(table) ? 15 : 16;
    constexpr std::array<unsigned, 4> reads{1, 2, 4, 3};
    return reads[static_cast<std::size_t>(table)];
}

enum class Kind : std::uint8_t {
    bit,
    unsigned_word,
    signed_word,
    unsigned_double,
    signed_double,
    float_double
};

/// physical = raw * factor + offset. By default a double word has its high word first, and a word its high
/// byte first (Modbus application protocol 1.1b3, section 4.2). Many devices differ: for the bytes ABCD,
/// swapped() reads CDAB, bytes_swapped() BADC, and both DCBA.
struct Register : ScaledValue<Register> {
    std::uint16_t at = 0; ///< counted from the row's address
    Kind kind = Kind::unsigned_word;
    bool low_word_first = false;
    bool low_byte_first = false;

    [[nodiscard]] constexpr unsigned width() const noexcept { return kind >= Kind::unsigned_double ? 2 : 1; }

    // Written as a row: word("pressure", 2).as_signed().times(0.01).in("bar")
    constexpr Register as_signed() const noexcept {
        return copy_with(*this, &Register::kind, width() == 2 ? Kind::signed_double : Kind::signed_word);
    }
    constexpr Register swapped() const noexcept { return copy_with(*this, &Register::low_word_first, true); }
    constexpr Register bytes_swapped() const noexcept {
        return copy_with(*this, &Register::low_byte_first, true);
    }
};

constexpr Register bit(std::string_view name, std::uint16_t at) noexcept { return {{{name}}, at, Kind::bit}; }
constexpr Register word(std::string_view name, std::uint16_t at) noexcept {
    return {{{name}}, at, Kind::unsigned_word};
}
constexpr Register double_word(std::string_view name, std::uint16_t at) noexcept {
    return {{{name}}, at, Kind::unsigned_double};
}
constexpr Register float_word(std::string_view name, std::uint16_t at) noexcept {
    return {{{name}}, at, Kind::float_double};
}

/// The words as the server stores them; a bit is one word of 0 or 1.
using Words = std::array<std::uint16_t, 2>;

constexpr std::uint16_t in_order(const Register& r, std::uint16_t word) noexcept {
    return r.low_byte_first ? std::byteswap(word) : word;
}

constexpr double to_physical(const Register& r, Words words) noexcept {
    for (std::uint16_t& word : words) word = in_order(r, word);
    const std::uint32_t high = r.low_word_first ? words[1] : words[0];
    const std::uint32_t low = r.low_word_first ? words[0] : words[1];
    const std::uint32_t both = high << 16 | low;
    double number = 0;
    switch (r.kind) {
    case Kind::bit:
    case Kind::unsigned_word: number = words[0]; break;
    case Kind::signed_word: number = static_cast<std::int16_t>(words[0]); break;
    case Kind::unsigned_double: number = both; break;
    case Kind::signed_double: number = static_cast<std::int32_t>(both); break;
    case Kind::float_double: number = static_cast<double>(std::bit_cast<float>(both)); break;
    }
    return number * r.factor + r.offset;
}

struct Encoded {
    Words words{};
    bool saturated = false; ///< out of range: became the nearest limit
    bool refused = false;   ///< not a number
};

constexpr Encoded to_words(const Register& r, double physical) noexcept {
    if (!is_number(physical)) return {.refused = true};
    const double number = (physical - r.offset) / r.factor; // infinite for a large one: the nearest limit
    double low = 0, high = 1;
    switch (r.kind) {
    case Kind::bit: break;
    case Kind::unsigned_word: high = 65535; break;
    case Kind::signed_word: low = -32768, high = 32767; break;
    case Kind::unsigned_double: high = 4294967295.0; break;
    case Kind::signed_double: low = -2147483648.0, high = 2147483647.0; break;
    case Kind::float_double: low = -3.4028234663852886e38, high = 3.4028234663852886e38; break;
    }
    const double kept = number < low ? low : number > high ? high : number;
    const bool saturated = kept != number;
    std::uint32_t both = 0;
    if (r.kind == Kind::float_double)
        both = std::bit_cast<std::uint32_t>(static_cast<float>(kept));
    else
        both = static_cast<std::uint32_t>(static_cast<std::int64_t>(kept < 0 ? kept - 0.5 : kept + 0.5));
    const auto low_word = in_order(r, static_cast<std::uint16_t>(both & 0xFFFFu));
    const auto high_word = in_order(r, static_cast<std::uint16_t>(both >> 16));
    if (r.width() == 1) return {.words = {low_word, 0}, .saturated = saturated};
    if (r.low_word_first) return {.words = {low_word, high_word}, .saturated = saturated};
    return {.words = {high_word, low_word}, .saturated = saturated};
}

} // namespace tappet::modbus

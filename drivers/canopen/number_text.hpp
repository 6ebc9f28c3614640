// Numbers in EDS files: hexadecimal, octal, decimal, relative to the node's identifier, and reals.
#pragma once

#include "drivers/canopen/ini.hpp"
#include "drivers/canopen/object_dictionary.hpp"
#include "drivers/canopen/real_text.hpp"

#include <bit>
#include <optional>

namespace tappet::canopen {

/// A whole number: 0x1F, 037, -31. Empty: not a number, or it does not fit 64 bits.
struct Whole {
    std::uint64_t size = 0;
    bool negative = false;
};
constexpr std::optional<Whole> to_whole(std::string_view text) noexcept {
    Whole number;
    if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
        number.negative = text.front() == '-';
        text.remove_prefix(1);
    }
    unsigned base = 10;
    if (text.size() > 2 && text[0] == '0' && lower(text[1]) == 'x') {
        base = 16;
        text.remove_prefix(2);
    } else if (text.size() > 1 && text[0] == '0') {
        base = 8;
    }
    if (text.empty()) return {};
    for (const char each : text) {
        const char c = lower(each);
        const unsigned digit = c >= '0' && c <= '9'   ? static_cast<unsigned>(c - '0')
                               : c >= 'a' && c <= 'f' ? static_cast<unsigned>(c - 'a') + 10
                                                      : 99;
        if (digit >= base || number.size > (~std::uint64_t{0} - digit) / base) return {};
        number.size = number.size * base + digit;
    }
    return number;
}

enum class NumberFault : std::uint8_t { none, no_number, does_not_fit };
struct NumberRead {
    Number number{};
    NumberFault fault = NumberFault::none;
};

/// Reads a value or a limit: $NODEID+0x180, 0x180+$NODEID, or a number that fits the type. An empty text: not
/// given.
constexpr NumberRead to_number(std::string_view text, DataType type) noexcept {
    if (text.empty()) return {};
    Number number;
    number.given = true;
    constexpr std::string_view variable = "$NODEID";
    if (text.size() >= variable.size() && same(text.substr(0, variable.size()), variable)) {
        number.plus_node = true;
        text = trimmed(text.substr(variable.size()));
        if (!text.empty() && text.front() != '+') return {{}, NumberFault::no_number};
        text = text.empty() ? "0" : trimmed(text.substr(1));
    } else if (text.size() > variable.size() && same(text.substr(text.size() - variable.size()), variable)) {
        number.plus_node = true;
        text = trimmed(text.substr(0, text.size() - variable.size()));
        if (text.empty() || text.back() != '+') return {{}, NumberFault::no_number};
        text = trimmed(text.substr(0, text.size() - 1));
    }
    const unsigned wide = bits_of(type);
    const bool bit_pattern = text.size() > 2 && text[0] == '0' && lower(text[1]) == 'x';
    if (is_real(type) && !bit_pattern) {
        const bool is_long = type == DataType::real64;
        const auto real = is_long ? to_real<double>(text) : to_real<float>(text);
        if (!real) return {{}, NumberFault::no_number};
        constexpr double infinity = std::numeric_limits<double>::infinity();
        if (*real == infinity || *real == -infinity) return {{}, NumberFault::does_not_fit};
        number.bits = is_long ? std::bit_cast<std::uint64_t>(*real)
                              : std::bit_cast<std::uint32_t>(static_cast<float>(*real));
        return {number, NumberFault::none};
    }
    const auto whole = to_whole(text);
    if (!whole) return {{}, NumberFault::no_number};
    const std::uint64_t most = low_bits(~std::uint64_t{0}, wide);
    // A negative number of a signed type, or its bit pattern.
    const bool negative = whole->negative && whole->size != 0;
    const bool fits = negative                          ? is_signed(type) && whole->size <= (most >> 1) + 1
                      : is_signed(type) && !bit_pattern ? whole->size <= most >> 1
                                                        : whole->size <= most;
    if (!fits) return {{}, NumberFault::does_not_fit};
    number.bits = low_bits(negative ? ~whole->size + 1 : whole->size, wide);
    return {number, NumberFault::none};
}

} // namespace tappet::canopen

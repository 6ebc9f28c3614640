// Numbers in EDS files: hexadecimal, octal, decimal, relative to the node's identifier, and reals.
#pragma once

#include "drivers/canopen/ini.hpp"
#include "drivers/canopen/object_dictionary.hpp"
#include "kernel/base/digits.hpp"

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

/// Returns a real: up to 15 digits and a power of ten up to 22, so that the result is exactly rounded.
constexpr std::optional<double> to_real(std::string_view text) noexcept {
    bool negative = false;
    if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
        negative = text.front() == '-';
        text.remove_prefix(1);
    }
    std::uint64_t digits = 0;
    int power = 0;
    bool any = false, dot = false;
    while (!text.empty() && lower(text.front()) != 'e') {
        const char c = text.front();
        text.remove_prefix(1);
        if (c == '.' && !dot) {
            dot = true;
            continue;
        }
        if (c < '0' || c > '9' || digits >= 100'000'000'000'000) return {};
        digits = digits * 10 + static_cast<unsigned>(c - '0');
        power -= dot ? 1 : 0;
        any = true;
    }
    if (!any) return {};
    if (!text.empty()) {
        text.remove_prefix(1);
        const bool down = text.starts_with('-');
        if (down || text.starts_with('+')) text.remove_prefix(1);
        if (text.empty()) return {};
        int exponent = 0;
        for (const char c : text) {
            if (c < '0' || c > '9' || exponent > 99) return {};
            exponent = exponent * 10 + (c - '0');
        }
        power += down ? -exponent : exponent;
    }
    if (power > 22 || power < -22) return {};
    const double size = real_of(digits, power);
    return negative ? -size : size;
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
        const auto real = to_real(text);
        if (!real) return {{}, NumberFault::no_number};
        number.bits = type == DataType::real64 ? std::bit_cast<std::uint64_t>(*real)
                                               : std::bit_cast<std::uint32_t>(static_cast<float>(*real));
        return {number, NumberFault::none};
    }
    const auto whole = to_whole(text);
    if (!whole) return {{}, NumberFault::no_number};
    const std::uint64_t most = low_bits(~std::uint64_t{0}, wide);
    // A negative number of a signed type, or its bit pattern.
    const bool fits = whole->negative                   ? is_signed(type) && whole->size <= (most >> 1) + 1
                      : is_signed(type) && !bit_pattern ? whole->size <= most >> 1
                                                        : whole->size <= most;
    if (!fits) return {{}, NumberFault::does_not_fit};
    number.bits = low_bits(whole->negative ? ~whole->size + 1 : whole->size, wide);
    return {number, NumberFault::none};
}

} // namespace tappet::canopen

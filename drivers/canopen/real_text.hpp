// A decimal number as the nearest real, at compile time too: as many digits as a file writes.
#pragma once

#include "kernel/base/digits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

namespace tappet::canopen {

namespace detail {

/// A natural number of up to 1536 bits.
class Natural {
public:
    static constexpr std::size_t capacity = 48;
    constexpr void multiply_add(std::uint32_t by, std::uint32_t more) noexcept {
        std::uint64_t carry = more;
        for (std::size_t i = 0; i < used_; ++i) {
            carry += std::uint64_t{words_[i]} * by;
            words_[i] = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
        if (carry != 0) words_[used_++] = static_cast<std::uint32_t>(carry);
    }
    constexpr void subtract(const Natural& less) noexcept {
        std::uint64_t borrow = 0;
        for (std::size_t i = 0; i < used_; ++i) {
            const std::uint64_t taken = borrow + (i < less.used_ ? less.words_[i] : 0);
            borrow = words_[i] < taken ? 1 : 0;
            words_[i] -= static_cast<std::uint32_t>(taken);
        }
        while (used_ != 0 && words_[used_ - 1] == 0) --used_;
    }
    friend constexpr bool operator<(const Natural& a, const Natural& b) noexcept {
        if (a.used_ != b.used_) return a.used_ < b.used_;
        for (std::size_t i = a.used_; i-- > 0;)
            if (a.words_[i] != b.words_[i]) return a.words_[i] < b.words_[i];
        return false;
    }

private:
    std::array<std::uint32_t, capacity> words_{};
    std::size_t used_ = 0;
};

/// Returns numerator / denominator, both not 0, rounded to the nearest Real, ties to even; infinity beyond
/// it.
template <class Real> constexpr double nearest_real(Natural numerator, Natural denominator) noexcept {
    using Limits = std::numeric_limits<Real>;
    int exponent = 0; // of the highest bit of the result
    for (; !(numerator < denominator); ++exponent) denominator.multiply_add(2, 0);
    for (; numerator < denominator; --exponent) numerator.multiply_add(2, 0);
    const int missing = Limits::min_exponent - 1 - exponent; // bits of a subnormal number
    const int bits = Limits::digits - (missing > 0 ? missing : 0);
    if (bits < 0) return 0;
    std::uint64_t mantissa = 0;
    for (int i = 0; i < bits; ++i) {
        mantissa <<= 1;
        if (!(numerator < denominator)) {
            numerator.subtract(denominator);
            mantissa |= 1;
        }
        numerator.multiply_add(2, 0);
    }
    const bool above = denominator < numerator, tie = !above && !(numerator < denominator);
    if (above || (tie && (mantissa & 1) != 0)) ++mantissa;
    auto value = static_cast<double>(mantissa);
    const double factor = exponent - bits + 1 < 0 ? 0.5 : 2;
    for (int left = exponent - bits + 1; left != 0; left += left < 0 ? 1 : -1) {
        value *= factor;
        if (value > static_cast<double>(Limits::max())) return Limits::infinity();
    }
    return value;
}

} // namespace detail

/// Returns the nearest Real; infinity where it lies beyond them. Empty: not a number, or of more than 40
/// digits.
template <class Real> constexpr std::optional<double> to_real(std::string_view text) noexcept {
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    detail::Natural numerator;
    std::uint64_t small = 0;
    int digits = 0, power = 0;
    bool any = false, dot = false;
    for (; !text.empty() && text.front() != 'e' && text.front() != 'E'; text.remove_prefix(1)) {
        const char c = text.front();
        if (c == '.' && !dot) {
            dot = true;
            continue;
        }
        if (!is_digit(c)) return {};
        any = true;
        power -= dot ? 1 : 0;
        if (digits == 0 && c == '0') continue;
        if (++digits > 40) return {};
        numerator.multiply_add(10, static_cast<std::uint32_t>(c - '0'));
        if (digits <= 15) small = small * 10 + static_cast<unsigned>(c - '0');
    }
    if (!any) return {};
    if (!text.empty()) {
        text.remove_prefix(1);
        const bool down = text.starts_with('-');
        if (down || text.starts_with('+')) text.remove_prefix(1);
        if (text.empty()) return {};
        int exponent = 0;
        for (const char c : text) {
            if (!is_digit(c)) return {};
            if (exponent < 10'000) exponent = exponent * 10 + (c - '0');
        }
        power += down ? -exponent : exponent;
    }
    double size = 0;
    if (digits == 0 || digits + power < -330) {
        size = 0;
    } else if (digits + power > 310) {
        size = std::numeric_limits<double>::infinity();
    } else if (sizeof(Real) == sizeof(double) && digits <= 15 && power >= -22 && power <= 22) {
        size = real_of(small, power);
    } else {
        detail::Natural denominator;
        denominator.multiply_add(1, 1);
        for (int i = 0; i < power; ++i) numerator.multiply_add(10, 0);
        for (int i = 0; i > power; --i) denominator.multiply_add(10, 0);
        size = detail::nearest_real<Real>(numerator, denominator);
    }
    return negative ? -size : size;
}

} // namespace tappet::canopen

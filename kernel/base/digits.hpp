// Decimal digits as a number; also in constant expressions.
#pragma once

#include <cstdint>

namespace tappet {

constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// Returns digits * 10^exponent: the nearest double where both are exactly representable (Clinger 1990),
/// otherwise within one unit of the last place.
constexpr double real_of(std::uint64_t digits, int exponent) noexcept {
    if (digits == 0 || exponent == 0) return static_cast<double>(digits);
    const bool shrinks = exponent < 0;
    const auto power_of_ten = [exponent, shrinks]<class Real>(Real power) {
        Real scale = 1;
        for (auto left = static_cast<unsigned>(shrinks ? -exponent : exponent); left != 0; left >>= 1) {
            if (left & 1u) scale *= power;
            if (left > 1) power *= power;
        }
        return scale;
    };
    const auto scaled = [digits, shrinks](auto scale) {
        const auto value = static_cast<decltype(scale)>(digits);
        return static_cast<double>(shrinks ? value / scale : value * scale);
    };
    constexpr int most_exact = 22; // 10^22 < 2^53 * 2^22, and is a double
    if (digits <= std::uint64_t{1} << 53 && exponent >= -most_exact && exponent <= most_exact)
        return scaled(power_of_ten(10.0));
    return scaled(power_of_ten(10.0L)); // whose long double would be rounded twice above
}

} // namespace tappet

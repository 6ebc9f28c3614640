// A number as an engineer writes it in a sentence; also in constant expressions.
#pragma once

#include "kernel/base/number.hpp"
#include "kernel/base/text.hpp"

namespace tappet {

/// Returns the number to the third decimal, without zeros at the end; beyond 1e15 only a limit. "infinity"
/// and "NaN" are not numbers.
constexpr Sentence decimal(double value) noexcept {
    if (value != value) return Sentence{"NaN"};
    if (!is_number(value)) return Sentence{value < 0 ? "-infinity" : "infinity"};
    constexpr double largest = 1e15; // in thousandths still a whole number of 64 bits
    if (!(value > -largest && value < largest))
        return Sentence{value < 0 ? "less than -1e15" : "more than 1e15"};
    const double size = value < 0 ? -value : value;
    auto thousandths = static_cast<std::int64_t>(size * 1000 + 0.5);
    Sentence text{value < 0 ? "-" : "", thousandths / 1000};
    thousandths %= 1000;
    if (thousandths != 0) text.add(".");
    for (std::int64_t digit = 100; thousandths != 0; digit /= 10) {
        text.add(thousandths / digit);
        thousandths %= digit;
    }
    return text;
}

} // namespace tappet

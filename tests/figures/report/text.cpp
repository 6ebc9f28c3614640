// Formatting without a locale.
#include "tests/figures/report/text.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace tappet::figures {

std::string number_text(double value) {
    if (!std::isfinite(value)) return "-";
    const double size = std::abs(value);
    std::array<char, 64> text{};
    if (size != 0 && size < 0.01)
        std::snprintf(text.data(), text.size(), "%.2g", value);
    else
        std::snprintf(text.data(), text.size(), "%.*f", size < 10 ? 2 : size < 100 ? 1 : 0, value);
    std::string number = text.data();
    if (size >= 1000) // in groups of three
        for (auto at = static_cast<std::ptrdiff_t>(number.size()) - 3; at > (value < 0 ? 1 : 0); at -= 3)
            number.insert(static_cast<std::size_t>(at), " ");
    return number;
}

std::string quantity(double value, const std::string& unit) {
    return number_text(value) + (unit.empty() ? "" : " " + unit);
}

} // namespace tappet::figures

// Formatting without a locale.
#include "tests/figures/report/text.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace tappet::figures {

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char character : text) switch (character) {
        case '&': safe += "&amp;"; break;
        case '<': safe += "&lt;"; break;
        case '>': safe += "&gt;"; break;
        case '"': safe += "&quot;"; break;
        case '\'': safe += "&#39;"; break;
        default: safe += character;
        }
    return safe;
}

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

namespace {

/// The part before the first comma.
std::string key_of(const Row& row) { return row.name.substr(0, row.name.find(',')); }

} // namespace

const Row& ours_beside(const Figure& figure, const Row& other) {
    const Row* first = &figure.rows.front();
    bool found = false;
    for (const Row& row : figure.rows) {
        if (row.role != Standing::ours) continue;
        if (key_of(row) == key_of(other)) return row;
        if (!found) first = &row;
        found = true;
    }
    return *first;
}

std::vector<Beside> beside(const Figure& figure, const Row& row) {
    std::vector<Beside> all;
    if (row.role != Standing::ours) return all;
    for (const Row& other : figure.rows) {
        if (other.role == Standing::ours || !(other.summary.median > 0)) continue;
        const std::string key = key_of(ours_beside(figure, other));
        if (key == key_of(other) && key != key_of(row)) continue;
        all.push_back({other.name, other.role, row.summary.median / other.summary.median,
                       row.summary.p99 / other.summary.p99});
        if (row.instructions && other.instructions && *other.instructions > 0)
            all.back().instructions = *row.instructions / *other.instructions;
    }
    return all;
}

} // namespace tappet::figures

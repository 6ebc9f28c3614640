// Units of measurement as the interfaces spell them. Compares two of them, so that no connection passes
// litres per minute to a reader that expects millilitres per second (ISO 80000-1; symbols of the SI
// brochure).
#pragma once

#include "kernel/component/facet.hpp"
#include "kernel/machine/table/connections.hpp"

#include <array>
#include <cstddef>
#include <string_view>

namespace tappet::checks {

/// A unit as powers of base quantities, and its size: 1 l/min is 1/60000 m3/s.
struct Unit {
    static constexpr std::size_t quantities = 8; ///< m, kg, s, A, K, rad, pieces, ratio
    std::array<int, quantities> powers{};
    double size = 1;
    bool known = true; ///< false: not a unit that can be parsed, but a word such as "picks"

    [[nodiscard]] constexpr bool same_kind(const Unit& other) const noexcept {
        return powers == other.powers;
    }
    [[nodiscard]] constexpr bool same(const Unit& other) const noexcept {
        const double ratio = size / other.size;
        return same_kind(other) && ratio > 1 - 1e-9 && ratio < 1 + 1e-9;
    }
};

namespace units_detail {

struct Symbol {
    std::string_view text;
    std::array<int, Unit::quantities> powers;
    double size;
    bool takes_prefix;
};
inline constexpr double turn = 6.283185307179586;
// clang-format off
inline constexpr Symbol symbols[] = {
    {"m",    {1},           1,            true},  {"g",   {0, 1},       1e-3,    true},
    {"s",    {0, 0, 1},     1,            true},  {"min", {0, 0, 1},    60,      false},
    {"h",    {0, 0, 1},     3600,         false}, {"A",   {0, 0, 0, 1}, 1,       true},
    {"K",    {0, 0, 0, 0, 1}, 1,          true},  {"degC", {0, 0, 0, 0, 2}, 1,   false}, // no ratio leads from one to the other
    {"rad",  {0, 0, 0, 0, 0, 1}, 1,       true},  {"deg", {0, 0, 0, 0, 0, 1}, turn / 360, false},
    {"rev",  {0, 0, 0, 0, 0, 1}, turn,    false}, {"rpm", {0, 0, -1, 0, 0, 1}, turn / 60, false},
    {"Hz",   {0, 0, -1},    1,            true},  {"l",   {3},          1e-3,    true},
    {"N",    {1, 1, -2},    1,            true},  {"Pa",  {-1, 1, -2},  1,       true},
    {"bar",  {-1, 1, -2},   1e5,          true},  {"J",   {2, 1, -2},   1,       true},
    {"W",    {2, 1, -3},    1,            true},  {"V",   {2, 1, -3, -1}, 1,     true},
    {"%",    {0, 0, 0, 0, 0, 0, 0, 1}, 1e-2, false}};
struct Prefix { char text; double size; };
inline constexpr Prefix prefixes[] = {{'u', 1e-6}, {'m', 1e-3}, {'c', 1e-2}, {'d', 1e-1}, {'k', 1e3}, {'M', 1e6}};
// clang-format on

/// Multiplies by one factor: a symbol with its prefix and its power, "mm2". Returns false when the symbol is
/// unknown.
constexpr bool multiply(Unit& unit, std::string_view factor, int sign) noexcept {
    int power = 1;
    if (!factor.empty() && factor.back() >= '2' && factor.back() <= '9') {
        power = factor.back() - '0';
        factor.remove_suffix(1);
    }
    const auto apply = [&](const Symbol& symbol, double prefix) {
        for (std::size_t q = 0; q < Unit::quantities; ++q) unit.powers[q] += sign * power * symbol.powers[q];
        for (int i = 0; i < power; ++i)
            unit.size = sign > 0 ? unit.size * symbol.size * prefix : unit.size / (symbol.size * prefix);
        return true;
    };
    for (const Symbol& symbol : symbols)
        if (symbol.text == factor) return apply(symbol, 1);
    for (const Symbol& symbol : symbols)
        for (const Prefix& prefix : prefixes)
            if (symbol.takes_prefix && factor.size() == symbol.text.size() + 1 && factor[0] == prefix.text &&
                factor.substr(1) == symbol.text)
                return apply(symbol, prefix.size);
    return factor == "1" && power == 1;
}

} // namespace units_detail

/// Parses "rpm", "rev/min", "mm/s2", "N m", "deg/s". Every factor after a slash divides.
constexpr Unit parse_unit(std::string_view text) noexcept {
    Unit unit;
    int sign = 1;
    while (true) {
        const std::size_t end = text.find_first_of("/. ");
        if (!units_detail::multiply(unit, text.substr(0, end), sign)) return {.known = false};
        if (end == std::string_view::npos) return unit;
        if (text[end] == '/') sign = -1;
        text.remove_prefix(end + 1);
    }
}

constexpr std::string_view in_unit(const Facet& facet) noexcept {
    return facet.unit.empty() ? "no unit" : facet.unit;
}
/// Whether a factor converts one unit to the other.
constexpr bool converts(const Unit& from, const Unit& to) noexcept {
    return from.known && to.known && from.same_kind(to);
}
/// Returns the factor that an accepted row applies to each value.
constexpr double factor_of(const ConnectionRow& row, const Facet& from, const Facet& to) noexcept {
    if (row.scale != 0) return row.scale;
    return row.converted ? parse_unit(from.unit).size / parse_unit(to.unit).size : 1.0;
}

} // namespace tappet::checks

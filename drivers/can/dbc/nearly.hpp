// Whether a name may be a damaged one: a name of a DBC file that means something, with one character wrong.
#pragma once

#include "drivers/can/dbc/scanner.hpp"
#include "kernel/base/nearest.hpp"

namespace tappet::can::dbc {

/// Returns whether the name differs from `meant` by one character or by case. Names that differ in a digit
/// are names of two things, as "ECU1" and "ECU2"; so are short ones with another character.
constexpr bool is_nearly(std::string_view name, std::string_view meant) noexcept {
    if (name == meant) return false;
    if (name.size() != meant.size()) // one character more or fewer
        return (name.size() > 1 || meant.size() > 1) &&
               edit_distance(name, meant, 1, LetterCase::ignored) == 1;
    std::size_t i = 0;
    while (lower_case(name[i]) == lower_case(meant[i]))
        if (++i == name.size()) return true;
    return name.size() > 3 && !is_digit(name[i]) && !is_digit(meant[i]) &&
           edit_distance(name, meant, 1, LetterCase::ignored) == 1;
}

/// Returns whether a node that BU_ does not name may be `own`: nearly, or with its comma lost.
constexpr bool may_be_node(std::string_view name, std::string_view own, std::string_view nodes) noexcept {
    const auto joins = [&](std::string_view other) {
        return !other.empty() && (names(nodes, other) || other == "Vector__XXX");
    };
    const std::size_t size = own.size();
    const bool is_joined = (name.starts_with(own) && joins(name.substr(size))) ||
                           (name.ends_with(own) && joins(name.substr(0, name.size() - size)));
    return (is_joined || is_nearly(name, own)) && !names(nodes, name);
}

} // namespace tappet::can::dbc

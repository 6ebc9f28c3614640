// The CPF type names that a value is written with, and read from.
#pragma once

#include "kernel/base/type_tag.hpp"

#include <array>
#include <string_view>

namespace tappet::cpf {

constexpr std::string_view type_name(const TypeTag& type) noexcept {
    const std::size_t size = type.size;
    switch (type.kind) {
    case ValueKind::boolean: return "boolean";
    case ValueKind::integer: return size <= 2 ? "short" : size == 4 ? "long" : "llong";
    case ValueKind::natural: return size <= 2 ? "ushort" : size == 4 ? "ulong" : "ullong";
    case ValueKind::real: return size == 4 ? "float" : "double";
    default: return "string";
    }
}

inline constexpr std::array<std::string_view, 6> integer_names{"short", "ushort", "long",
                                                               "ulong", "llong",  "ullong"};

/// Whether a value of the type may be read from that CPF type. A whole number may be read as a real number;
/// otherwise the kinds must agree. The width is not compared: the value itself is checked.
constexpr bool reads_as(const TypeTag& type, std::string_view name) noexcept {
    bool integer = false;
    for (const std::string_view each : integer_names) integer |= name == each;
    switch (type.kind) {
    case ValueKind::integer:
    case ValueKind::natural: return integer;
    case ValueKind::real: return integer || name == "float" || name == "double";
    default: return name == type_name(type);
    }
}

} // namespace tappet::cpf

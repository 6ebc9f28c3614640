// Names of operators in scripts, and the result of a look-up.
#pragma once

#include "kernel/program/registered.hpp"

namespace tappet {

enum class Operator : std::uint8_t {
    add,
    subtract,
    multiply,
    divide,
    remainder,
    equal,
    unequal,
    less,
    at_most,
    greater,
    at_least,
    both,
    either,
    negate, ///< from here on, of one operand
    invert
};

/// Returns the operator's spelling in scripts.
constexpr std::string_view to_text(Operator op) noexcept {
    constexpr std::string_view spelled[] = {"+",  "-", "*",  "/",  "%",  "==", "!=", "<",
                                            "<=", ">", ">=", "&&", "||", "-",  "!"};
    return spelled[static_cast<std::size_t>(op)];
}

/// How an expression is computed. `instruction` is complete except for `to`, `a`, `b` and `link`. Operands of
/// other types than `a` and `b` are converted to them first. The result may be of a stored type; it is
/// converted to script_type(result) before further use.
struct OperatorMatch {
    Instruction instruction{};
    TypeId result = nullptr;
    TypeId a = nullptr;
    TypeId b = nullptr; ///< null: one operand
    constexpr explicit operator bool() const noexcept { return instruction.run != nullptr; }
};

/// How a value of type `a` is converted to type `to`.
struct Conversion {
    Instruction instruction{};
    bool implicit = false; ///< done wherever a value of the other type is expected, without a request
    constexpr explicit operator bool() const noexcept { return instruction.run != nullptr; }
};

inline constexpr TypeId script_bool = type_id<bool>;
inline constexpr TypeId script_int = type_id<ScriptInt>;
inline constexpr TypeId script_double = type_id<double>;
inline constexpr TypeId script_duration = type_id<Duration>;
/// A text literal in a script. Longer ones are refused.
using ScriptText = Text<60>;
inline constexpr TypeId script_text = type_id<ScriptText>;

/// Returns the type that scripts compute with after reading a value of type `stored`: bool, int, double or
/// Duration for every C++ type of that kind, else the type itself.
constexpr TypeId script_type(TypeId stored) noexcept {
    switch (stored->kind) {
    case ValueKind::boolean: return script_bool;
    case ValueKind::integer:
    case ValueKind::natural: return script_int;
    case ValueKind::real: return script_double;
    case ValueKind::duration: return script_duration;
    default: return stored;
    }
}

/// Returns the last part of a C++ name: "Pose" of "car::Pose".
constexpr std::string_view short_name(std::string_view name) noexcept {
    const std::size_t template_at = name.find('<');
    const std::size_t colon = name.substr(0, template_at).rfind(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}
/// Returns the spelling of a type in scripts.
constexpr std::string_view type_name(TypeId type) noexcept {
    if (type == nullptr) return "nothing";
    switch (type->kind) {
    case ValueKind::boolean: return "bool";
    case ValueKind::integer:
    case ValueKind::natural: return "int";
    case ValueKind::real: return "double";
    case ValueKind::duration: return "duration";
    case ValueKind::text: return "text";
    default: return short_name(type->name);
    }
}

} // namespace tappet

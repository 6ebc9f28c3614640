// Words for operators of scripts, and what is found for one.
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
    negate, ///< of one operand, from here on
    invert
};

/// As it is spelled.
constexpr std::string_view to_text(Operator op) noexcept {
    constexpr std::string_view spelled[] = {"+",  "-", "*",  "/",  "%",  "==", "!=", "<",
                                            "<=", ">", ">=", "&&", "||", "-",  "!"};
    return spelled[static_cast<std::size_t>(op)];
}

/// How an expression is computed. Of `instruction` everything is set but `to`, `a`, `b` and `link`. Operands
/// that are not of the types `a` and `b` are converted to them first; the result may be of a stored type,
/// which is converted to script_type(result) before it is reckoned with.
struct OperatorMatch {
    Instruction instruction{};
    TypeId result = nullptr;
    TypeId a = nullptr;
    TypeId b = nullptr; ///< null: one operand
    constexpr explicit operator bool() const noexcept { return instruction.run != nullptr; }
};

/// How a value becomes one of another type, from `a` to `to`.
struct Conversion {
    Instruction instruction{};
    bool implicit = false; ///< done where a value of the other type is expected, without being asked for
    constexpr explicit operator bool() const noexcept { return instruction.run != nullptr; }
};

inline constexpr TypeId script_bool = type_id<bool>;
inline constexpr TypeId script_int = type_id<ScriptInt>;
inline constexpr TypeId script_double = type_id<double>;
inline constexpr TypeId script_duration = type_id<Duration>;
/// Of a text in the script itself. Longer ones are refused.
using ScriptText = Text<60>;
inline constexpr TypeId script_text = type_id<ScriptText>;

/// The type that a script reckons with when a value of this one was read: bool, int, double or Duration for
/// every C++ type of that kind, else the type itself.
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

/// The last part of a C++ name: "Pose" of "car::Pose".
constexpr std::string_view short_name(std::string_view name) noexcept {
    const std::size_t template_at = name.find('<');
    const std::size_t colon = name.substr(0, template_at).rfind(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}
/// As scripts spell a type.
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

// What a script's expression means: for an operator, a function or a conversion and the types of its operands
// the instruction that computes it. Tables of data; the same while the C++ compiler runs and on the target.
#pragma once

#include "kernel/program/actions.hpp"
#include "kernel/program/primitives_matrix.hpp"
#include "kernel/program/primitives_scalar.hpp"
#include "kernel/program/primitives_value.hpp"
#include "kernel/program/registered.hpp"

#include <span>

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
constexpr TypeId script_type(TypeId stored) noexcept;
/// A matrix of doubles, 1 to 4 rows and columns, for products and literals; null: none of that shape.
constexpr TypeId matrix_type(std::size_t rows, std::size_t columns) noexcept;

/// `op` of two operands; false: these types have none.
constexpr OperatorMatch find_binary(Operator op, TypeId a, TypeId b) noexcept;
/// Operator::negate or Operator::invert.
constexpr OperatorMatch find_unary(Operator op, TypeId a) noexcept;
/// A function of one or two operands: those of <cmath>, of matrices and times, those that the types register.
constexpr OperatorMatch find_function(std::string_view name, std::span<const TypeId> operands) noexcept;
/// Names for "did you mean": those of the functions that find_function knows without registered ones.
constexpr std::span<const std::string_view> function_names() noexcept;
/// Types are the same, or alike (every C++ number to and from the script's own; int to double; texts of other
/// lengths; matrices of one shape): implicit. By name only, as int(x): double to int, bool to int,
/// enumeration to int.
constexpr Conversion find_conversion(TypeId from, TypeId to) noexcept;

// ---- parts of values and what steers a node

/// `to` = a, both of this type.
constexpr Instruction copy_instruction(TypeId type) noexcept {
    return {.run = &primitive::copy, .size = static_cast<std::uint16_t>(type->size)};
}
/// The action fails.
constexpr Instruction fail_instruction() noexcept { return {.run = &primitive::fail}; }
/// When the bool `a` is not `wanted`, the next `count` instructions of this node are left out. For a && b: a
/// into the result, skip what b needs unless it is true, b into the result.
constexpr Instruction skip_instruction(bool wanted, std::uint16_t count) noexcept {
    return {.run = wanted ? &primitive::skip_unless : &primitive::skip_if, .size = count};
}
/// `to` = a.field, of the field's type.
constexpr Instruction field_read(const RecordField& field) noexcept {
    return {
        .run = &primitive::field_read, .size = static_cast<std::uint16_t>(field.type->size), .field = &field};
}
/// to.field = `a`
constexpr Instruction field_write(const RecordField& field) noexcept {
    return {.run = &primitive::field_write,
            .size = static_cast<std::uint16_t>(field.type->size),
            .field = &field};
}
/// `to` = a[b] of a matrix, std::array or Sequence, counted through all its elements as they lie; `b` is an
/// int. The element's type is type->element. Null run: it has no elements.
constexpr Instruction element_read(TypeId type) noexcept;
/// to[b] = `a`
constexpr Instruction element_write(TypeId type) noexcept;
/// `to` = the int with which element_read finds row `a`, column `b`.
constexpr Instruction matrix_index(TypeId type) noexcept;

} // namespace tappet

#include "kernel/program/operator_search.hpp"

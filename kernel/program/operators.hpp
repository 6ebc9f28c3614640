// The meaning of a script's expressions: finds the instruction for an operator, a function or a conversion
// and its operand types. Tables of data; the same in the C++ compiler and on the target.
#pragma once

#include "kernel/program/actions.hpp"
#include "kernel/program/operator_matrices.hpp"
#include "kernel/program/operator_tables.hpp"

#include <span>

namespace tappet {

// ---- parts of values and flow within a node

/// `to` = a, both of this type.
constexpr Instruction copy_instruction(TypeId type) noexcept {
    return {.run = &primitive::copy, .size = static_cast<std::uint16_t>(type->size)};
}
/// Makes the action fail.
constexpr Instruction fail_instruction() noexcept { return {.run = &primitive::fail}; }
/// When the bool `a` is not `wanted`, skips the next `count` instructions of this node. For a && b: compute a
/// into the result, skip the instructions of b unless it is true, compute b into the result.
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

/// Implicit conversions: between equal types and alike ones (every C++ number to and from the script's own;
/// int to double; texts of other lengths; matrices of one shape). Conversions by name only, as int(x): double
/// to int, bool to int, enumeration to int.
constexpr Conversion find_conversion(TypeId from, TypeId to) noexcept {
    if (from == to) return {copy_instruction(from), true};
    for (const detail::ConversionRow& row : detail::conversion_rows)
        if (row.from == from && row.to == to) return {{.run = row.run}, row.implicit};
    const bool from_script = from == script_type(from), to_script = to == script_type(to);
    // C++ numbers to the script's numbers, and back.
    if (to == script_int && (detail::is_integer(from) || from->kind == ValueKind::enumeration)) {
        const TypeId stored = from->kind == ValueKind::enumeration ? from->element : from;
        return {{.run = detail::widenings[detail::width_index(stored, stored->kind == ValueKind::natural)]},
                from->kind != ValueKind::enumeration};
    }
    if (from == script_int && detail::is_integer(to))
        return {{.run = detail::narrowings[detail::width_index(to, to->kind == ValueKind::natural)]}, true};
    if (to == script_double && detail::is_float(from))
        return {{.run = &primitive::unary<float, double, &primitive::widen_real>}, true};
    if (from == script_double && detail::is_float(to))
        return {{.run = &primitive::unary<double, float, &primitive::narrow_real>}, true};
    // Other types of the same kind and size: Time and Duration, bool under another name.
    if (from_script != to_script && script_type(from) == script_type(to) && from->size == to->size &&
        !detail::is_integer(from) && from->kind != ValueKind::real)
        return {copy_instruction(from), true};
    if (from->kind == ValueKind::text && to->kind == ValueKind::text)
        return {{.run = &primitive::text_copy,
                 .size = static_cast<std::uint16_t>(to->columns),
                 .rows = static_cast<std::uint8_t>(from->length_at & 0xff),
                 .inner = static_cast<std::uint8_t>(from->length_at >> 8)},
                true};
    if (detail::same_shape(from, to)) {
        if (detail::same_order(from, to)) return {copy_instruction(from), true};
        const Primitive run = detail::matrix_function(detail::element_kind(from), "transpose");
        Instruction reorder = detail::matrix_instruction(run, from->rows, 0, from->columns);
        reorder.size = detail::orders(from, nullptr, to);
        return {reorder, true};
    }
    return {};
}

/// Finds `op` for two operands; false: not defined for these types.
constexpr OperatorMatch find_binary(Operator op, TypeId a, TypeId b) noexcept {
    if (const OperatorMatch found = detail::find_registered(to_text(op), a, b)) return found;
    if (a->kind == ValueKind::matrix || b->kind == ValueKind::matrix)
        return detail::find_matrix_binary(op, a, b);
    const bool compares = op == Operator::equal || op == Operator::unequal;
    if (a->kind == ValueKind::enumeration && a == b && compares)
        return {{.run = op == Operator::equal ? primitive::bytes_equal : primitive::bytes_unequal,
                 .size = static_cast<std::uint16_t>(a->size)},
                script_bool,
                a,
                b};
    if (a->kind == ValueKind::text && b->kind == ValueKind::text && compares)
        return {{.run = op == Operator::equal ? primitive::text_equal : primitive::text_unequal,
                 .size = static_cast<std::uint16_t>(a->length_at),
                 .rows = static_cast<std::uint8_t>(b->length_at & 0xff),
                 .inner = static_cast<std::uint8_t>(b->length_at >> 8)},
                script_bool,
                a,
                b};
    TypeId left = script_type(a), right = script_type(b);
    for (int widened = 0; widened < 2; ++widened) {
        for (const detail::BinaryRow& row : detail::binary_rows)
            if (row.op == op && row.a == left && row.b == right)
                return {{.run = row.run}, row.result, row.a, row.b};
        const bool mixed =
            (left == script_int && right == script_double) || (left == script_double && right == script_int);
        if (!mixed) break;
        left = right = script_double;
    }
    return {};
}

/// Finds Operator::negate or Operator::invert.
constexpr OperatorMatch find_unary(Operator op, TypeId a) noexcept {
    if (const OperatorMatch found = detail::find_registered(to_text(op), a, nullptr)) return found;
    if (const auto kind = detail::element_kind(a);
        kind != detail::ElementKind::none && op == Operator::negate)
        return {detail::matrix_instruction(detail::matrix_function(kind, "negate"), a->rows, 0, a->columns),
                a, a, nullptr};
    for (const detail::UnaryRow& row : detail::unary_rows)
        if (row.op == op && row.a == script_type(a)) return {{.run = row.run}, row.result, row.a, nullptr};
    return {};
}

/// Finds a function of one or two operands: from <cmath>, of matrices and times, or registered by the types.
constexpr OperatorMatch find_function(std::string_view name, std::span<const TypeId> operands) noexcept {
    if (operands.empty() || operands.size() > 2) return {};
    const TypeId a = operands[0], b = operands.size() == 2 ? operands[1] : nullptr;
    if (const OperatorMatch found = detail::find_registered(name, a, b)) return found;
    if (const OperatorMatch found = detail::find_matrix_function(name, a, b)) return found;
    if (name == "size" && b == nullptr && a->kind == ValueKind::sequence)
        return {{.run = &primitive::sequence_size,
                 .size = static_cast<std::uint16_t>(a->length_at),
                 .rows = static_cast<std::uint8_t>(a->columns & 0xff),
                 .inner = static_cast<std::uint8_t>(a->columns >> 8)},
                script_int,
                a,
                nullptr};
    if (b == nullptr && (name == "int" || name == "double")) {
        const TypeId to = name == "int" ? script_int : script_double;
        const TypeId from = a->kind == ValueKind::enumeration ? a : script_type(a);
        if (const Conversion made = find_conversion(from, to)) return {made.instruction, to, from, nullptr};
        return {};
    }
    TypeId left = script_type(a), right = b == nullptr ? nullptr : script_type(b);
    for (int widened = 0; widened < 2; ++widened) {
        for (const detail::FunctionRow& row : detail::function_rows)
            if (row.name == name && row.a == left && row.b == right)
                return {{.run = row.run}, row.result, row.a, row.b};
        if (left == script_int) left = script_double;
        if (right == script_int) right = script_double;
    }
    return {};
}

/// Returns the functions known to find_function without registered ones, for "did you mean".
constexpr std::span<const std::string_view> function_names() noexcept { return detail::known_functions; }

namespace detail {

constexpr Instruction element_instruction(Primitive run, TypeId type) noexcept {
    if (type->kind != ValueKind::matrix && type->kind != ValueKind::sequence) return {};
    const std::size_t count = type->kind == ValueKind::matrix ? type->rows * type->columns : type->columns;
    return {.run = run,
            .size = static_cast<std::uint16_t>(type->element->size),
            .rows = static_cast<std::uint8_t>(count & 0xff),
            .inner = static_cast<std::uint8_t>(count >> 8)};
}

} // namespace detail

/// `to` = a[b] of a matrix or std::array, counted through all its elements in memory order, or of the
/// elements in a Sequence; `b` is an int. The element's type is type->element. Null run: the type has no
/// elements.
constexpr Instruction element_read(TypeId type) noexcept {
    return detail::element_instruction(
        type->kind == ValueKind::sequence ? &primitive::sequence_read : &primitive::element_read, type);
}
/// to[b] = `a`
constexpr Instruction element_write(TypeId type) noexcept {
    return detail::element_instruction(
        type->kind == ValueKind::sequence ? &primitive::sequence_write : &primitive::element_write, type);
}
/// `to` = the int index of row `a`, column `b` for element_read.
constexpr Instruction matrix_index(TypeId type) noexcept {
    if (detail::element_kind(type) == detail::ElementKind::none) return {};
    return detail::matrix_instruction(&primitive::matrix_index, type->rows, type->row_major ? 1 : 0,
                                      type->columns);
}

} // namespace tappet

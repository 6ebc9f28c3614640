// Matrix operators for operators.hpp, by the shapes of the operands, and operators that types register.
#pragma once

#include "kernel/program/operator_kinds.hpp"
#include "kernel/program/primitives_matrix.hpp"

namespace tappet::detail {

// ---- matrices

template <class E>
struct MatrixPrimitives {
    static constexpr Primitive binary(Operator op) noexcept {
        switch (op) {
        case Operator::add: return &primitive::elementwise<E, &primitive::add_elements<E>>;
        case Operator::subtract: return &primitive::elementwise<E, &primitive::subtract_elements<E>>;
        case Operator::multiply: return &primitive::product<E>;
        case Operator::equal: return &primitive::matrices_equal<E>;
        case Operator::unequal: return &primitive::matrices_unequal<E>;
        default: return nullptr;
        }
    }
    static constexpr Primitive function(std::string_view name) noexcept {
        if (name == "dot") return &primitive::dot<E>;
        if (name == "cross") return &primitive::cross<E>;
        if (name == "norm") return &primitive::norm<E>;
        if (name == "transpose") return &primitive::transposed<E>;
        if (name == "negate") return &primitive::negated<E>;
        if (name == "scale") return &primitive::scaled<E, &primitive::scale_element<E>>;
        if (name == "scale by") return &primitive::scaled_by<E>;
        if (name == "shrink") return &primitive::scaled<E, &primitive::shrink_element<E>>;
        return nullptr;
    }
};

enum class ElementKind : std::uint8_t { none, of_double, of_float, of_int };
constexpr ElementKind element_kind(TypeId type) noexcept {
    if (type->kind != ValueKind::matrix || type->rows > 0xff || type->columns > 0xff)
        return ElementKind::none;
    const TypeTag& element = *type->element;
    if (element.kind == ValueKind::real)
        return element.size == sizeof(double) ? ElementKind::of_double : ElementKind::of_float;
    if (element.kind == ValueKind::integer && element.size == sizeof(std::int32_t))
        return ElementKind::of_int;
    return ElementKind::none;
}
constexpr Primitive matrix_binary(ElementKind kind, Operator op) noexcept {
    switch (kind) {
    case ElementKind::of_double: return MatrixPrimitives<double>::binary(op);
    case ElementKind::of_float: return MatrixPrimitives<float>::binary(op);
    case ElementKind::of_int: return MatrixPrimitives<std::int32_t>::binary(op);
    case ElementKind::none: break;
    }
    return nullptr;
}
constexpr Primitive matrix_function(ElementKind kind, std::string_view name) noexcept {
    switch (kind) {
    case ElementKind::of_double: return MatrixPrimitives<double>::function(name);
    case ElementKind::of_float: return MatrixPrimitives<float>::function(name);
    case ElementKind::of_int:
        return name == "norm" ? nullptr : MatrixPrimitives<std::int32_t>::function(name);
    case ElementKind::none: break;
    }
    return nullptr;
}
constexpr TypeId scale_type(ElementKind kind) noexcept {
    return kind == ElementKind::of_int ? script_int : script_double;
}
constexpr bool is_matrix_vector(TypeId type) noexcept { return type->rows == 1 || type->columns == 1; }
constexpr bool same_shape(TypeId a, TypeId b) noexcept {
    return a->kind == ValueKind::matrix && b->kind == ValueKind::matrix && a->rows == b->rows &&
           a->columns == b->columns && a->element == b->element;
}
/// Returns whether both store their elements in the same order; vectors always do.
constexpr bool same_order(TypeId a, TypeId b) noexcept {
    return a->row_major == b->row_major || is_matrix_vector(a);
}

inline constexpr std::size_t most_matrix_rows = 4;
inline constexpr std::string_view matrix_names[most_matrix_rows][most_matrix_rows] = {
    {"double[1][1]", "double[1][2]", "double[1][3]", "double[1][4]"},
    {"double[2][1]", "double[2][2]", "double[2][3]", "double[2][4]"},
    {"double[3][1]", "double[3][2]", "double[3][3]", "double[3][4]"},
    {"double[4][1]", "double[4][2]", "double[4][3]", "double[4][4]"}};
template <std::size_t rows, std::size_t columns>
inline constexpr TypeTag matrix_tag = [] {
    TypeTag tag;
    tag.name = matrix_names[rows - 1][columns - 1];
    tag.size = rows * columns * sizeof(double);
    tag.align = alignof(double);
    tag.kind = ValueKind::matrix;
    tag.element = script_double;
    tag.rows = rows, tag.columns = columns;
    return tag;
}();
/// Row-major.
inline constexpr auto matrix_tags = []<std::size_t... i>(std::index_sequence<i...>) {
    return std::array<TypeId, sizeof...(i)>{
        &matrix_tag<i / most_matrix_rows + 1, i % most_matrix_rows + 1>...};
}(std::make_index_sequence<most_matrix_rows * most_matrix_rows>{});

} // namespace tappet::detail

namespace tappet {

/// Returns a matrix of doubles, 1 to 4 rows and columns, for products and literals; null: no such shape.
constexpr TypeId matrix_type(std::size_t rows, std::size_t columns) noexcept {
    if (rows == 0 || columns == 0 || rows > detail::most_matrix_rows || columns > detail::most_matrix_rows)
        return nullptr;
    return detail::matrix_tags[(rows - 1) * detail::most_matrix_rows + columns - 1];
}

} // namespace tappet

namespace tappet::detail {

/// Returns the best type of that shape: the type of an operand, or a general one. Null: none.
constexpr TypeId shaped(std::size_t rows, std::size_t columns, TypeId a, TypeId b) noexcept {
    for (const TypeId each : {a, b})
        if (each != nullptr && each->rows == rows && each->columns == columns) return each;
    return a->element == script_double ? matrix_type(rows, columns) : nullptr;
}
constexpr Instruction matrix_instruction(Primitive run, std::size_t rows, std::size_t inner,
                                         std::size_t columns) noexcept {
    return {.run = run,
            .rows = static_cast<std::uint8_t>(rows),
            .inner = static_cast<std::uint8_t>(inner),
            .columns = static_cast<std::uint8_t>(columns)};
}
constexpr std::uint16_t orders(TypeId a, TypeId b, TypeId to) noexcept {
    return static_cast<std::uint16_t>((a->row_major ? primitive::a_row_major : 0) |
                                      (b != nullptr && b->row_major ? primitive::b_row_major : 0) |
                                      (to->row_major ? primitive::to_row_major : 0));
}

constexpr OperatorMatch matrix_product(TypeId a, TypeId b) noexcept {
    if (a->columns != b->rows || a->element != b->element || element_kind(b) == ElementKind::none) return {};
    const Primitive run = matrix_binary(element_kind(a), Operator::multiply);
    Instruction product = matrix_instruction(run, a->rows, a->columns, b->columns);
    if (a->rows == 1 && b->columns == 1) return {product, a->element, a, b}; // a single number
    const TypeId result = shaped(a->rows, b->columns, a, b);
    if (result == nullptr) return {};
    product.size = orders(a, b, result);
    return {product, result, a, b};
}

constexpr OperatorMatch find_matrix_binary(Operator op, TypeId a, TypeId b) noexcept {
    const ElementKind kind_a = element_kind(a), kind_b = element_kind(b);
    if (kind_a != ElementKind::none && kind_b != ElementKind::none) {
        if (op == Operator::multiply) return matrix_product(a, b);
        const Primitive run = matrix_binary(kind_a, op);
        if (run == nullptr || !same_shape(a, b)) return {};
        const bool compares = op == Operator::equal || op == Operator::unequal;
        return {matrix_instruction(run, a->rows, 0, a->columns), compares ? script_bool : a, a, a};
    }
    const bool left = kind_a != ElementKind::none;
    const ElementKind kind = left ? kind_a : kind_b;
    const TypeId matrix = left ? a : b;
    const TypeId number = script_type(left ? b : a);
    if (kind == ElementKind::none || (number != script_double && number != script_int) ||
        (number == script_double && scale_type(kind) == script_int))
        return {};
    if (op != Operator::multiply && !(left && op == Operator::divide)) return {};
    const Primitive run = matrix_function(kind, op == Operator::divide ? "shrink"
                                                : left                 ? "scale"
                                                                       : "scale by");
    return {matrix_instruction(run, matrix->rows, 0, matrix->columns), matrix,
            left ? matrix : scale_type(kind), left ? scale_type(kind) : matrix};
}

constexpr OperatorMatch find_matrix_function(std::string_view name, TypeId a, TypeId b) noexcept {
    const ElementKind kind = element_kind(a);
    if (kind == ElementKind::none) return {};
    const Primitive run = matrix_function(kind, name);
    if (run == nullptr) return {};
    Instruction found = matrix_instruction(run, a->rows, 0, a->columns);
    if (b != nullptr) {
        if (!same_shape(a, b) || !is_matrix_vector(a)) return {};
        if (name == "dot") return {found, scale_type(kind), a, b};
        if (name == "cross" && a->rows * a->columns == 3) return {found, a, a, b};
        return {};
    }
    if (name == "norm") return {found, script_double, a, nullptr};
    if (name != "transpose") return {};
    const TypeId result = shaped(a->columns, a->rows, a, nullptr);
    if (result == nullptr) return {};
    found.inner = 1;
    found.size = orders(a, nullptr, result);
    return {found, result, a, nullptr};
}

// ---- registered operators

/// Returns the cost of passing a value of type `given` for an operand of type `wanted`; -1: not possible.
constexpr int operand_distance(TypeId given, TypeId wanted) noexcept {
    if (given == wanted) return 0;
    if (script_type(given) == script_type(wanted)) return 1;
    if (script_type(given) == script_int && script_type(wanted) == script_double) return 2;
    return same_shape(given, wanted) ? 1 : -1;
}
constexpr OperatorMatch find_registered(std::string_view name, TypeId a, TypeId b) noexcept {
    OperatorMatch best;
    int least = 100;
    for (const TypeId owner : {a, b}) {
        if (owner == nullptr) continue;
        for (std::size_t i = 0; i < owner->operator_count; ++i) {
            const RegisteredOperator& each = owner->operators[i];
            if (each.name != name || (b == nullptr) != (each.operands[1] == nullptr)) continue;
            const int first = operand_distance(a, each.operands[0]);
            const int second = b == nullptr ? 0 : operand_distance(b, each.operands[1]);
            if (first < 0 || second < 0 || first + second >= least) continue;
            least = first + second;
            best = {{.run = each.run}, each.result, each.operands[0], each.operands[1]};
        }
    }
    return best;
}

} // namespace tappet::detail

// Primitives on matrices and vectors of fixed size; the instruction gives their shape. Numbers of type E,
// column-major unless a flag says otherwise. The result must not overlap an operand.
#pragma once

#include "kernel/program/value_access.hpp"

#include <cmath>

namespace tappet::primitive {

/// Operands of a product or of a transposition that are row-major; in the instruction's `size`.
enum RowMajor : std::uint16_t { a_row_major = 1, b_row_major = 2, to_row_major = 4 };

template <class E>
constexpr E element(const std::byte* matrix, std::size_t i) noexcept TAPPET_REALTIME {
    return load_value<E>(matrix + i * sizeof(E));
}
template <class E>
constexpr void put_element(std::byte* matrix, std::size_t i, E value) noexcept TAPPET_REALTIME {
    store_value(matrix + i * sizeof(E), value);
}
constexpr std::size_t elements_of(const Instruction& in) noexcept TAPPET_REALTIME {
    return std::size_t{in.rows} * in.columns;
}

// An integer overflow fails the action.
template <class E>
constexpr bool add_elements(E a, E b, E& to) noexcept TAPPET_REALTIME {
    if constexpr (std::is_integral_v<E>) return !__builtin_add_overflow(a, b, &to);
    to = a + b;
    return true;
}
template <class E>
constexpr bool subtract_elements(E a, E b, E& to) noexcept TAPPET_REALTIME {
    if constexpr (std::is_integral_v<E>) return !__builtin_sub_overflow(a, b, &to);
    to = a - b;
    return true;
}
template <class E>
constexpr bool multiply_elements(E a, E b, E& to) noexcept TAPPET_REALTIME {
    if constexpr (std::is_integral_v<E>) return !__builtin_mul_overflow(a, b, &to);
    to = a * b;
    return true;
}
/// Type of the number that scales a matrix: a double, for integer elements an int.
template <class E>
using Scale = std::conditional_t<std::is_integral_v<E>, ScriptInt, double>;
template <class E>
constexpr bool scale_element(E a, Scale<E> b, E& to) noexcept TAPPET_REALTIME {
    if constexpr (std::is_integral_v<E>) return !__builtin_mul_overflow(ScriptInt{a}, b, &to);
    to = static_cast<E>(static_cast<Scale<E>>(a) * b);
    return true;
}
template <class E>
constexpr bool shrink_element(E a, Scale<E> b, E& to) noexcept TAPPET_REALTIME {
    if constexpr (std::is_integral_v<E>) {
        if (b == 0) return false;
        return !__builtin_add_overflow(ScriptInt{a} / b, ScriptInt{0}, &to);
    }
    to = static_cast<E>(static_cast<Scale<E>>(a) / b);
    return true;
}

template <class E, bool (*F)(E, E, E&) noexcept TAPPET_REALTIME>
constexpr ActionResult elementwise(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                                   const std::byte* b) noexcept TAPPET_REALTIME {
    const std::size_t count = elements_of(in);
    for (std::size_t i = 0; i < count; ++i) {
        E value{};
        if (!F(element<E>(a, i), element<E>(b, i), value)) return ActionResult::failed;
        put_element(to, i, value);
    }
    return ActionResult::done;
}
template <class E>
constexpr ActionResult negated(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                               const std::byte*) noexcept TAPPET_REALTIME {
    const std::size_t count = elements_of(in);
    for (std::size_t i = 0; i < count; ++i) {
        E value{};
        if constexpr (std::is_integral_v<E>) {
            if (!subtract_elements(E{0}, element<E>(a, i), value)) return ActionResult::failed;
        } else {
            value = -element<E>(a, i);
        }
        put_element(to, i, value);
    }
    return ActionResult::done;
}
/// `b` is the number.
template <class E, bool (*F)(E, Scale<E>, E&) noexcept TAPPET_REALTIME>
constexpr ActionResult scaled(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                              const std::byte* b) noexcept TAPPET_REALTIME {
    const std::size_t count = elements_of(in);
    const auto number = load_value<Scale<E>>(b);
    for (std::size_t i = 0; i < count; ++i) {
        E value{};
        if (!F(element<E>(a, i), number, value)) return ActionResult::failed;
        put_element(to, i, value);
    }
    return ActionResult::done;
}
/// `a` is the number.
template <class E>
constexpr ActionResult scaled_by(ProgramContext& context, const Instruction& in, std::byte* to,
                                 const std::byte* a, const std::byte* b) noexcept TAPPET_REALTIME {
    return scaled<E, &scale_element<E>>(context, in, to, b, a);
}

constexpr std::size_t place_of(bool row_major, std::size_t rows, std::size_t columns, std::size_t i,
                               std::size_t j) noexcept TAPPET_REALTIME {
    return row_major ? i * columns + j : j * rows + i;
}
template <class E>
constexpr ActionResult product(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                               const std::byte* b) noexcept TAPPET_REALTIME {
    const std::size_t rows = in.rows, inner = in.inner, columns = in.columns;
    for (std::size_t j = 0; j < columns; ++j)
        for (std::size_t i = 0; i < rows; ++i) {
            E sum{};
            for (std::size_t k = 0; k < inner; ++k) {
                E value{};
                if (!multiply_elements(
                        element<E>(a, place_of((in.size & a_row_major) != 0, rows, inner, i, k)),
                        element<E>(b, place_of((in.size & b_row_major) != 0, inner, columns, k, j)), value) ||
                    !add_elements(sum, value, sum))
                    return ActionResult::failed;
            }
            put_element(to, place_of((in.size & to_row_major) != 0, rows, columns, i, j), sum);
        }
    return ActionResult::done;
}
/// `a` is rows x columns. With `inner`, `to` is its transpose; without, the same matrix in the other element
/// order.
template <class E>
constexpr ActionResult transposed(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                                  const std::byte*) noexcept TAPPET_REALTIME {
    const std::size_t rows = in.rows, columns = in.columns;
    const bool turn = in.inner != 0;
    for (std::size_t j = 0; j < columns; ++j)
        for (std::size_t i = 0; i < rows; ++i) {
            const E value = element<E>(a, place_of((in.size & a_row_major) != 0, rows, columns, i, j));
            const bool by_row = (in.size & to_row_major) != 0;
            put_element(to,
                        turn ? place_of(by_row, columns, rows, j, i) : place_of(by_row, rows, columns, i, j),
                        value);
        }
    return ActionResult::done;
}

/// Dot product over all elements of two vectors: a double, for integer elements an int.
template <class E>
constexpr ActionResult dot(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                           const std::byte* b) noexcept TAPPET_REALTIME {
    const std::size_t count = elements_of(in);
    Scale<E> sum{};
    for (std::size_t i = 0; i < count; ++i) {
        Scale<E> value{};
        if (!multiply_elements(Scale<E>{element<E>(a, i)}, Scale<E>{element<E>(b, i)}, value) ||
            !add_elements(sum, value, sum))
            return ActionResult::failed;
    }
    store_value(to, sum);
    return ActionResult::done;
}
/// Euclidean norm over all elements.
template <class E>
ActionResult norm(ProgramContext&, const Instruction& in, std::byte* to, const std::byte* a,
                  const std::byte*) noexcept TAPPET_REALTIME {
    const std::size_t count = elements_of(in);
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto value = static_cast<double>(element<E>(a, i));
        sum += value * value;
    }
    store_value(to, std::sqrt(sum));
    return ActionResult::done;
}
/// Cross product of two vectors with three elements.
template <class E>
constexpr ActionResult cross(ProgramContext&, const Instruction&, std::byte* to, const std::byte* a,
                             const std::byte* b) noexcept TAPPET_REALTIME {
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        E left{}, right{}, value{};
        if (!multiply_elements(element<E>(a, j), element<E>(b, k), left) ||
            !multiply_elements(element<E>(a, k), element<E>(b, j), right) ||
            !subtract_elements(left, right, value))
            return ActionResult::failed;
        put_element(to, i, value);
    }
    return ActionResult::done;
}

template <class E>
constexpr bool same_elements(const Instruction& in, const std::byte* a, const std::byte* b) noexcept
    TAPPET_REALTIME {
    const std::size_t count = elements_of(in);
    for (std::size_t i = 0; i < count; ++i)
        if (!(element<E>(a, i) == element<E>(b, i))) return false;
    return true;
}
template <class E>
constexpr ActionResult matrices_equal(ProgramContext&, const Instruction& in, std::byte* to,
                                      const std::byte* a, const std::byte* b) noexcept TAPPET_REALTIME {
    store_value(to, same_elements<E>(in, a, b));
    return ActionResult::done;
}
template <class E>
constexpr ActionResult matrices_unequal(ProgramContext&, const Instruction& in, std::byte* to,
                                        const std::byte* a, const std::byte* b) noexcept TAPPET_REALTIME {
    store_value(to, !same_elements<E>(in, a, b));
    return ActionResult::done;
}

} // namespace tappet::primitive

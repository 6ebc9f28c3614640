// Values while a script is compiled: known ones, those in the data, conversions and operators.
#pragma once

#include "kernel/program/operators.hpp"
#include "kernel/script/emitter.hpp"

namespace tappet::script_detail {

/// The value of a variable, or a value known at compile time.
struct Operand {
    TypeId type = nullptr;
    DataOffset at = no_data;
    bool literal = false;  ///< stored below, not in the data: bools, numbers, times, texts, names of values
    bool constant = false; ///< its bytes are among the constants
    bool simple = false;   ///< the last instruction made it, in the scratch: it may write it elsewhere
    std::int64_t integer = 0;
    double real = 0;
    std::string_view text{};

    [[nodiscard]] constexpr bool valid() const noexcept { return type != nullptr; }
};

constexpr Operand literal_of(TypeId type, std::int64_t integer, double real,
                             std::string_view text = {}) noexcept {
    return {.type = type, .literal = true, .integer = integer, .real = real, .text = text};
}
constexpr Operand integer_literal(std::int64_t value) noexcept {
    return literal_of(script_int, value, static_cast<double>(value));
}
constexpr Operand at_place(TypeId type, DataOffset at) noexcept { return {.type = type, .at = at}; }
/// Returns the result of the instruction just emitted.
constexpr Operand made(TypeId type, DataOffset at) noexcept {
    return {.type = type, .at = at, .simple = true};
}
/// Returns a field or element; a part of a place is a place.
constexpr Operand part_of(const Operand& whole, TypeId type, std::size_t offset) noexcept {
    return {.type = type, .at = moved(whole.at, offset), .constant = whole.constant};
}

constexpr void store_integer(std::int64_t value, std::size_t size, std::byte* into) noexcept {
    for (std::size_t i = 0; i < size; ++i)
        into[i] = static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i));
}
/// Encodes a text with its escapes; false: it is too long.
constexpr bool encode_text(std::string_view text, TypeId type, std::byte* into) noexcept {
    std::size_t used = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        char character = text[i];
        if (character == '\\' && i + 1 < text.size()) {
            character = text[++i];
            if (character == 'n')
                character = '\n';
            else if (character == 't')
                character = '\t';
        }
        if (used == type->columns) return false;
        into[used++] = static_cast<std::byte>(character);
    }
    store_value(into + type->length_at, static_cast<std::uint32_t>(used));
    return true;
}
/// Encodes a literal as a value of `type`; false: it is not one.
constexpr bool encode(const Operand& value, TypeId type, std::byte* into) noexcept {
    switch (type->kind) {
    case ValueKind::boolean:
        if (value.type != script_bool) return false;
        store_value(into, value.integer != 0);
        return true;
    case ValueKind::integer:
    case ValueKind::natural: {
        if (value.type != script_int) return false;
        const bool is_signed = type->kind == ValueKind::integer;
        const std::size_t bits = 8 * type->size - (is_signed ? 1 : 0);
        if (value.integer < 0 && (!is_signed || (bits < 63 && value.integer < -(std::int64_t{1} << bits))))
            return false;
        if (value.integer >= 0 && bits < 63 && value.integer >> bits != 0) return false;
        store_integer(value.integer, type->size, into);
        return true;
    }
    case ValueKind::real:
        if (value.type != script_int && value.type != script_double) return false;
        if (type->size == sizeof(double)) {
            store_value(into, value.real);
        } else {
            if (value.real > 3.4028234663852886e38 || value.real < -3.4028234663852886e38) return false;
            store_value(into, static_cast<float>(value.real));
        }
        return true;
    case ValueKind::duration:
        if (value.type != script_duration) return false;
        store_value(into, value.integer);
        return true;
    case ValueKind::enumeration:
        if (value.type != type) return false;
        store_integer(value.integer, type->size, into);
        return true;
    case ValueKind::text: return value.type == script_text && encode_text(value.text, type, into);
    default: return false;
    }
}

/// Computes with two known numbers or times; an operation that would fail is left to fail at run time.
constexpr bool fold(Operator op, const Operand& a, const Operand& b, Operand& into) noexcept {
    if (a.type == b.type && (a.type == script_int || a.type == script_duration)) {
        std::int64_t result = 0;
        if (op == Operator::add        ? __builtin_add_overflow(a.integer, b.integer, &result)
            : op == Operator::subtract ? __builtin_sub_overflow(a.integer, b.integer, &result)
                                       : op != Operator::multiply || a.type == script_duration ||
                                             __builtin_mul_overflow(a.integer, b.integer, &result))
            return false;
        into = literal_of(a.type, result, static_cast<double>(result));
        return true;
    }
    const auto is_number = [](const Operand& x) { return x.type == script_int || x.type == script_double; };
    if (!is_number(a) || !is_number(b) || (a.type == script_int && b.type == script_int)) return false;
    // The results of these two must not become too large: a constant expression has no infinity.
    const auto is_modest = [](double x) { return x < 1e100 && x > -1e100; };
    if (!is_modest(a.real) || !is_modest(b.real)) return false;
    double result = 0;
    switch (op) {
    case Operator::add: result = a.real + b.real; break;
    case Operator::subtract: result = a.real - b.real; break;
    case Operator::multiply: result = a.real * b.real; break;
    case Operator::divide:
        if (b.real < 1e-100 && b.real > -1e-100) return false;
        result = a.real / b.real;
        break;
    default: return false;
    }
    into = literal_of(script_double, 0, result);
    return true;
}

class Values {
public:
    constexpr Values(Reader& text, Emitter& out) : text_{text}, out_{out} {}

    /// Reports a fault; returns no value.
    constexpr Operand fail(const Token& at, std::initializer_list<std::string_view> pieces) {
        text_.fail(at, pieces);
        return {};
    }
    constexpr Operand fail_type(const Token& at, TypeId found, std::string_view wanted,
                                std::string_view where) {
        return fail(at, {"found a value of type ", type_name(found), ", expected ", wanted, where});
    }

    // ---- conversions

    /// Returns the value as one of exactly this type, in the data.
    constexpr Operand as(const Token& at, const Operand& value, TypeId type, std::string_view where) {
        if (!text_.ok()) return {};
        if (value.literal) return constant(at, value, type, where);
        if (value.type == type) return value;
        const Conversion conversion = find_conversion(value.type, type);
        if (conversion && conversion.implicit)
            return convert(conversion, value, type, out_.scratch(type->size));
        if (script_type(value.type) == value.type) return fail_type(at, value.type, type_name(type), where);
        return as(at, reckoned(at, value), type, where); // another width: by the script's own
    }
    constexpr Operand convert(const Conversion& conversion, const Operand& value, TypeId type,
                              DataOffset to) {
        Instruction in = conversion.instruction;
        in.to = to;
        in.a = value.at;
        out_.emit(in);
        return made(type, to);
    }
    /// Adds a literal to the constants.
    constexpr Operand constant(const Token& at, const Operand& value, TypeId type, std::string_view where) {
        Operand placed = at_place(type, no_data);
        placed.constant = true;
        std::byte bytes[8] = {};
        if (type->size <= 8 && encode(value, type, bytes)) {
            placed.at = out_.small_constant(load_value<std::uint64_t>(bytes));
            return placed;
        }
        if (type->size > 8 && type->kind == value.type->kind) {
            std::byte* const big = out_.add_constant(type->size, placed.at);
            if (big == nullptr || encode(value, type, big)) return placed;
        }
        if (type->kind == value.type->kind || (value.type == script_int && type->kind == ValueKind::natural))
            text_.fail(at, {"found a value that does not fit into ", short_name(type->name), where,
                            "; write one that does"});
        else
            fail_type(at, value.type, type_name(type), where);
        return {};
    }
    /// Returns the value in the data, with the type it has.
    constexpr Operand in_data(const Token& at, const Operand& value) {
        return value.literal ? constant(at, value, value.type, "") : value;
    }
    /// Converts C++ numbers of any width to the script's numbers.
    constexpr Operand reckoned(const Token& at, const Operand& value) {
        if (!text_.ok() || value.literal) return value;
        const TypeId type = script_type(value.type);
        return type == value.type ? value : as(at, value, type, "");
    }
    /// Emits to = value, converted to the type of `to`.
    constexpr void store(const Token& at, const Operand& value, TypeId type, DataOffset to,
                         std::string_view where) {
        if (!text_.ok()) return;
        if (!value.literal && value.type != type) {
            const Conversion conversion = find_conversion(value.type, type);
            if (conversion && conversion.implicit) {
                convert(conversion, value, type, to);
                return;
            }
            if (script_type(value.type) == value.type)
                return static_cast<void>(fail_type(at, value.type, type_name(type), where));
            return store(at, reckoned(at, value), type, to, where);
        }
        const Operand ready = as(at, value, type, where);
        if (!text_.ok()) return;
        // A number is made in its destination; a larger value might still be read while it is made.
        if (ready.simple && type->size <= 8 && out_.last_instruction().to == ready.at) {
            out_.last_instruction().to = to;
            return;
        }
        copy(type, ready.at, to);
    }
    /// Emits to = from, both of this type.
    constexpr void copy(TypeId type, DataOffset from, DataOffset to) {
        Instruction in = copy_instruction(type);
        in.to = to;
        in.a = from;
        out_.emit(in);
    }

    // ---- operators

    constexpr Operand combine(const Token& at, Operator op, const Operand& left, const Operand& right) {
        Operand known;
        if (left.literal && right.literal && fold(op, left, right, known)) return known;
        const OperatorMatch match = find_binary(op, left.type, right.type);
        if (!match)
            return fail(at, {"there is no ", type_name(left.type), " ", to_text(op), " ",
                             type_name(right.type), "; convert one of them, as with double(x)"});
        const Operand a = as(at, left, match.a, ""), b = as(at, right, match.b, "");
        return apply(match, a, b);
    }
    /// Negates the value if `at` is a minus; else inverts it.
    constexpr Operand combine_unary(const Token& at, const Operand& inner) {
        const bool negates = at.sign == Sign::minus;
        if (inner.literal && negates &&
            (inner.type == script_int || inner.type == script_double || inner.type == script_duration) &&
            inner.integer != std::numeric_limits<std::int64_t>::min())
            return inner.type == script_int ? integer_literal(-inner.integer) // integers have no -0
                                            : literal_of(inner.type, -inner.integer, -inner.real);
        if (inner.literal && !negates && inner.type == script_bool)
            return literal_of(script_bool, inner.integer == 0, 0);
        const OperatorMatch match = find_unary(negates ? Operator::negate : Operator::invert, inner.type);
        if (!match)
            return fail(at, {"there is no ", negates ? "-" : "!", " of ", type_name(inner.type),
                             negates ? "" : "; compare it with something"});
        return apply(match, as(at, inner, match.a, ""), {});
    }
    constexpr Operand apply(const OperatorMatch& match, const Operand& a, const Operand& b) {
        if (!text_.ok()) return {};
        Instruction in = match.instruction;
        in.a = a.at;
        in.b = b.at;
        return made(match.result, out_.emit_to_scratch(in, match.result->size));
    }

private:
    Reader& text_;
    Emitter& out_;
};

} // namespace tappet::script_detail

// Values while a script is compiled: known ones, those in the data, and conversions.
#pragma once

#include "kernel/script/compiler_names.hpp"

namespace tappet::script_detail {

class Values : protected Names {
protected:
    using Names::Names;

    // ---- values

    static constexpr Operand literal_of(TypeId type, std::int64_t integer, double real) noexcept {
        Operand value;
        value.type = type;
        value.literal = true;
        value.integer = integer;
        value.real = real;
        return value;
    }
    static constexpr Operand integer_literal(std::int64_t value) noexcept {
        return literal_of(script_int, value, static_cast<double>(value));
    }
    static constexpr Operand at_place(TypeId type, DataOffset at) noexcept {
        Operand value;
        value.type = type;
        value.at = at;
        return value;
    }
    /// Returns the result of the instruction just emitted.
    static constexpr Operand made(TypeId type, DataOffset at) noexcept {
        Operand value = at_place(type, at);
        value.simple = true;
        return value;
    }

    /// Encodes a literal as a value of `type`; false: it is not one.
    static constexpr bool encode(const Operand& value, TypeId type, std::byte* into) noexcept {
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
            if (value.integer < 0 &&
                (!is_signed || (bits < 63 && value.integer < -(std::int64_t{1} << bits))))
                return false;
            if (value.integer >= 0 && bits < 63 && value.integer >> bits != 0) return false;
            for (std::size_t i = 0; i < type->size; ++i)
                into[i] = static_cast<std::byte>(static_cast<std::uint64_t>(value.integer) >> (8 * i));
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
            for (std::size_t i = 0; i < type->size; ++i)
                into[i] = static_cast<std::byte>(static_cast<std::uint64_t>(value.integer) >> (8 * i));
            return true;
        case ValueKind::text: {
            if (value.type != script_text) return false;
            std::size_t used = 0;
            for (std::size_t i = 0; i < value.text.size(); ++i) {
                char character = value.text[i];
                if (character == '\\' && i + 1 < value.text.size()) {
                    character = value.text[++i];
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
        default: return false;
        }
    }
    constexpr void fail_type(const Token& at, TypeId found, std::string_view wanted, std::string_view where) {
        fail(at, {"found a value of type ", type_name(found), ", expected ", wanted, where});
    }
    /// Returns the value as one of exactly this type, in the data.
    constexpr Operand as(const Token& at, const Operand& value, TypeId type, std::string_view where) {
        if (!ok()) return {};
        if (value.literal) return constant(at, value, type, where);
        if (value.type == type) return value;
        const Conversion conversion = find_conversion(value.type, type);
        if ((!conversion || !conversion.implicit) && script_type(value.type) != value.type)
            return as(at, reckoned(at, value), type, where);
        if (!conversion || !conversion.implicit) {
            fail_type(at, value.type, type_name(type), where);
            return {};
        }
        return convert(conversion, value, type, scratch(type->size));
    }
    constexpr Operand convert(const Conversion& conversion, const Operand& value, TypeId type,
                              DataOffset to) {
        Instruction in = conversion.instruction;
        in.to = to;
        in.a = value.at;
        emit(in);
        return made(type, to);
    }
    constexpr Operand constant(const Token& at, const Operand& value, TypeId type, std::string_view where) {
        Operand placed = at_place(type, no_data);
        placed.constant = true;
        std::byte bytes[8] = {};
        if (type->size <= 8 && encode(value, type, bytes)) {
            placed.at = small_constant(load_value<std::uint64_t>(bytes), type->size);
            return placed;
        }
        if (type->size > 8 && type->kind == value.type->kind) {
            std::byte* const big = add_constant(type->size, placed.at);
            if (big == nullptr || encode(value, type, big)) return placed;
        }
        if (type->kind == value.type->kind || (value.type == script_int && type->kind == ValueKind::natural))
            fail(at, {"found a value that does not fit into ", short_name(type->name), where,
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
        if (!ok() || value.literal) return value;
        const TypeId type = script_type(value.type);
        return type == value.type ? value : as(at, value, type, "");
    }
    /// Emits to = value, converted to the type of `to`.
    constexpr void store(const Token& at, const Operand& value, TypeId type, DataOffset to,
                         std::string_view where) {
        if (!ok()) return;
        if (!value.literal && value.type != type) {
            const Conversion conversion = find_conversion(value.type, type);
            if (conversion && conversion.implicit) {
                convert(conversion, value, type, to);
                return;
            }
            if (script_type(value.type) == value.type)
                return fail_type(at, value.type, type_name(type), where);
            return store(at, reckoned(at, value), type, to, where); // another width: by the script's own
        }
        const Operand ready = as(at, value, type, where);
        if (!ok()) return;
        // A number is made in its destination; a larger value might still be read while it is made.
        if (ready.simple && type->size <= 8 && last_instruction().to == ready.at) {
            last_instruction().to = to;
            return;
        }
        Instruction in = copy_instruction(type);
        in.to = to;
        in.a = ready.at;
        emit(in);
    }
};

} // namespace tappet::script_detail

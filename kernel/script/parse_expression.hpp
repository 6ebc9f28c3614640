// Expressions, one function for each level of the grammar. Known values are computed at compile time, others
// by instructions into the scratch.
#pragma once

#include "kernel/script/basis.hpp"

namespace tappet::script_detail {

class Calls;

class Expressions {
public:
    /// Expressions and calls contain each other.
    constexpr Expressions(Basis& basis, Calls& calls) : basis_{basis}, calls_{calls} {}

    /// Parses an expression; `expected` gives names of enumerations their meaning.
    constexpr Operand parse(TypeId expected = nullptr) {
        if (!text_.enter()) return {};
        Operand value = parse_binary(0, expected);
        if (text_.ok() && text_.is(Sign::question)) value = parse_choice(value, expected);
        text_.leave();
        return value;
    }
    /// Parses an expression as a value of this type in the data.
    constexpr Operand parse_as(TypeId type) {
        const Token at = text_.token();
        return values_.as(at, parse(type), type, "");
    }
    constexpr Operand parse_condition() {
        const Token at = text_.token();
        const Operand value = parse(script_bool);
        if (text_.ok() && script_type(value.type) != script_bool)
            values_.fail_type(at, value.type, "a condition of type bool", "");
        return value;
    }
    /// Parses a value that is known at compile time.
    constexpr Operand parse_known(TypeId expected, std::string_view what) {
        const Token at = text_.token();
        const std::uint16_t before = out_.instruction_count();
        const Operand value = parse(expected);
        if (text_.ok() && (out_.instruction_count() != before || !(value.literal || value.constant)))
            text_.fail(at,
                       {what, " must be known before the machine runs; write numbers, texts or constants"});
        return value;
    }
    /// Parses a constant's value of this type, if any: a literal, or bytes among the constants.
    constexpr Operand parse_constant(TypeId type, std::string_view what) {
        const Token at = text_.token();
        const Operand value = parse_known(type, what);
        if (!text_.ok() || type == nullptr || value.type == type) return value;
        if (!value.literal) return values_.fail_type(at, value.type, type_name(type), "");
        const Operand placed = values_.as(at, value, type, "");
        return type == script_double ? literal_of(script_double, 0, value.real) : placed;
    }

    // ---- parts of values

    /// Parses the field or element after a dot or bracket of a value.
    constexpr Operand parse_part(const Operand& whole) {
        const Token at = text_.token();
        if (whole.literal) return values_.fail(at, {"a ", type_name(whole.type), " has no parts"});
        if (text_.is(Sign::open_square)) return parse_element(whole);
        text_.advance();
        const Token name = text_.need_word("the name of a field");
        if (!text_.ok()) return {};
        const TypeId type = whole.type;
        if (type->kind == ValueKind::record) {
            for (const RecordField& field : type->fields)
                if (field.name == name.text) return part_of(whole, field.type, field.offset());
            text_.fail_unknown(name, "field", type->fields, " in the record");
            return {};
        }
        if (type->kind == ValueKind::matrix && type->columns == 1 && name.text.size() == 1) {
            const std::size_t i = name.text[0] == 'w' ? 3 : static_cast<std::size_t>(name.text[0] - 'x');
            if (name.text[0] >= 'w' && name.text[0] <= 'z' && i < type->rows)
                return part_of(whole, type->element, i * type->element->size);
        }
        return values_.fail(name, {"a ", type_name(type), " has no \"", quoted(name.text),
                                   "\"; fields are those of records, and x, y, z of vectors"});
    }
    struct Index {
        bool is_known = false;
        std::size_t number = 0; ///< among the elements in memory order
        DataOffset at = no_data;
    };
    /// "[i]"; for a matrix of several rows and columns "[i][j]" or "[i, j]"; counted from 0.
    constexpr Index parse_index(TypeId type) {
        Index index;
        const Token at = text_.token();
        if (!text_.need(Sign::open_square, "\"[\"")) return index;
        if (type->kind != ValueKind::matrix && type->kind != ValueKind::sequence) {
            text_.fail(at, {"a ", type_name(type), " has no elements"});
            return index;
        }
        const bool is_matrix = type->kind == ValueKind::matrix && type->rows > 1 && type->columns > 1;
        const std::size_t rows = is_matrix                         ? type->rows
                                 : type->kind == ValueKind::matrix ? type->rows * type->columns
                                                                   : type->columns;
        const Operand row = parse_subscript(rows);
        if (!is_matrix) {
            text_.need(Sign::close_square, "\"]\"");
            if (!text_.ok()) return index;
            index.is_known = row.literal && type->kind == ValueKind::matrix;
            index.number = static_cast<std::size_t>(row.integer);
            if (!index.is_known) index.at = values_.in_data(at, row).at;
            return index;
        }
        if (!text_.take(Sign::comma)) {
            text_.need(Sign::close_square, "\"]\"");
            text_.need(Sign::open_square, "\"[\" and the column");
        }
        const Operand column = parse_subscript(type->columns);
        text_.need(Sign::close_square, "\"]\"");
        if (!text_.ok()) return index;
        if (row.literal && column.literal) {
            const auto r = static_cast<std::size_t>(row.integer),
                       c = static_cast<std::size_t>(column.integer);
            index.is_known = true;
            index.number = type->row_major ? r * type->columns + c : c * type->rows + r;
            return index;
        }
        Instruction in = matrix_index(type);
        in.to = out_.scratch(sizeof(ScriptInt));
        in.a = values_.in_data(at, row).at;
        in.b = values_.in_data(at, column).at;
        out_.emit(in);
        index.at = in.to;
        return index;
    }
    constexpr void fail_unknown(const Token& name, TypeId expected) {
        if (!text_.ok()) return;
        Nearest nearest{name.text};
        scope_.consider_all(nearest);
        peers_.consider_all(nearest);
        if (expected != nullptr)
            for (const std::string_view each : expected->names) nearest.consider(each);
        text_.fail_unknown(name, "name", nearest, "");
    }

private:
    constexpr Operand parse_choice(const Operand& condition, TypeId expected) {
        const Token at = text_.token();
        text_.advance();
        if (condition.type != script_bool)
            return values_.fail_type(at, condition.type, "a condition of type bool", " before ?");
        const Operand asked = values_.in_data(at, condition);
        const std::uint16_t first_skip = begin_skip(true);
        Token where = text_.token();
        const Operand one = values_.reckoned(where, parse_binary(0, expected));
        if (!text_.ok()) return {};
        const DataOffset to = out_.scratch(one.type->size);
        values_.store(where, one, one.type, to, "");
        end_skip(first_skip, asked.at);
        if (!text_.need(Sign::colon, "\":\" and the other value")) return {};
        const std::uint16_t second_skip = begin_skip(false);
        where = text_.token();
        values_.store(where, parse(one.type), one.type, to, " as before the \":\"");
        end_skip(second_skip, asked.at);
        return at_place(one.type, to);
    }
    /// Emits an instruction that skips those before end_skip() when its condition is not `wanted`.
    constexpr std::uint16_t begin_skip(bool wanted) {
        out_.emit(skip_instruction(wanted, 0));
        return static_cast<std::uint16_t>(out_.instruction_count() - 1);
    }
    constexpr void end_skip(std::uint16_t number, DataOffset condition) {
        if (!text_.ok()) return;
        Instruction& skip = out_.instructions[number];
        skip.a = condition;
        skip.size = static_cast<std::uint16_t>(out_.instruction_count() - number - 1);
    }

    struct Level {
        Operator op = Operator::add;
        int binds = -1; ///< higher binds stronger; -1: not a binary operator
    };
    static constexpr Level level_of(Sign sign) noexcept {
        switch (sign) {
        case Sign::logical_or: return {Operator::either, 0};
        case Sign::logical_and: return {Operator::both, 1};
        case Sign::equal: return {Operator::equal, 2};
        case Sign::unequal: return {Operator::unequal, 2};
        case Sign::less: return {Operator::less, 3};
        case Sign::at_most: return {Operator::at_most, 3};
        case Sign::greater: return {Operator::greater, 3};
        case Sign::at_least: return {Operator::at_least, 3};
        case Sign::plus: return {Operator::add, 4};
        case Sign::minus: return {Operator::subtract, 4};
        case Sign::times: return {Operator::multiply, 5};
        case Sign::divide: return {Operator::divide, 5};
        case Sign::remainder: return {Operator::remainder, 5};
        default: return {};
        }
    }
    constexpr Operand parse_binary(int weakest, TypeId expected) {
        Operand left = parse_unary(expected);
        for (;;) {
            const Level level = level_of(text_.token().sign);
            if (!text_.ok() || level.binds < weakest) return left;
            if (!text_.enter()) return {};
            const Token at = text_.token();
            text_.advance();
            if (level.op == Operator::both || level.op == Operator::either) {
                left = parse_logical(at, level, left);
            } else {
                const Operand right =
                    parse_binary(level.binds + 1, left.type != nullptr ? left.type : expected);
                left = text_.ok() ? values_.combine(at, level.op, left, right) : Operand{};
            }
            text_.leave();
        }
    }
    /// The right side is evaluated only when the left one does not decide.
    constexpr Operand parse_logical(const Token& at, Level level, const Operand& left) {
        const bool is_and = level.op == Operator::both;
        if (script_type(left.type) != script_bool)
            return values_.fail_type(at, left.type, "bool", is_and ? " before &&" : " before ||");
        const DataOffset to = out_.scratch(1);
        values_.store(at, left, script_bool, to, "");
        const std::uint16_t skip = begin_skip(is_and);
        const Token where = text_.token();
        const Operand right = parse_binary(level.binds + 1, script_bool);
        values_.store(where, right, script_bool, to, is_and ? " after &&" : " after ||");
        end_skip(skip, to);
        return at_place(script_bool, to);
    }
    constexpr Operand parse_unary(TypeId expected) {
        if (text_.is(Sign::plus)) text_.advance();
        if (!text_.is(Sign::minus) && !text_.is(Sign::invert)) return parse_postfix(expected);
        if (!text_.enter()) return {};
        const Token at = text_.token();
        text_.advance();
        const Operand inner = parse_unary(expected);
        text_.leave();
        return text_.ok() ? values_.combine_unary(at, inner) : Operand{};
    }
    constexpr Operand parse_postfix(TypeId expected) {
        Operand value = parse_primary(expected);
        while (text_.ok() && (text_.is(Sign::dot) || text_.is(Sign::open_square))) value = parse_part(value);
        return value;
    }
    constexpr Operand parse_element(const Operand& whole) {
        const Token at = text_.token();
        const Index index = parse_index(whole.type);
        if (!text_.ok()) return {};
        const TypeId element = whole.type->element;
        if (index.is_known) return part_of(whole, element, index.number * element->size);
        Instruction in = element_read(whole.type);
        if (in.run == nullptr) return values_.fail(at, {"a ", type_name(whole.type), " has no elements"});
        in.a = whole.at;
        in.b = index.at;
        return made(element, out_.emit_to_scratch(in, element->size));
    }
    constexpr Operand parse_subscript(std::size_t size) {
        const Token at = text_.token();
        const Operand value = values_.reckoned(at, parse(script_int));
        if (!text_.ok()) return {};
        if (value.type != script_int)
            values_.fail_type(at, value.type, "an int", " as an index");
        else if (value.literal && (value.integer < 0 || value.integer >= static_cast<std::int64_t>(size)))
            text_.fail(at, {"found an index out of range; elements are counted from 0 on, and there are ",
                            text_.digits(size)});
        return value;
    }

    // ---- first tokens of an expression

    constexpr Operand parse_primary(TypeId expected) {
        const Token at = text_.token();
        switch (at.sign) {
        case Sign::integer: text_.advance(); return integer_literal(at.integer);
        case Sign::real: text_.advance(); return literal_of(script_double, 0, at.real);
        case Sign::duration: text_.advance(); return literal_of(script_duration, at.integer, 0);
        case Sign::k_true:
        case Sign::k_false: text_.advance(); return literal_of(script_bool, at.sign == Sign::k_true, 0);
        case Sign::text: text_.advance(); return literal_of(script_text, 0, 0, at.text);
        case Sign::open_round: {
            text_.advance();
            const Operand value = parse(expected);
            text_.need(Sign::close_round, "\")\"");
            return value;
        }
        case Sign::name: text_.advance(); return parse_named(at, expected);
        default: text_.fail_expected("a value"); return {};
        }
    }
    constexpr Operand parse_named(const Token& name, TypeId expected);
    constexpr Operand value_of(const Token& name, TypeId type) {
        for (std::size_t i = 0; i < type->names.size(); ++i)
            if (type->names[i] == name.text) return literal_of(type, static_cast<std::int64_t>(i), 0);
        return {};
    }
    /// Parses "Type.value" of an enumeration after the type.
    constexpr Operand parse_value_of(TypeId type) {
        text_.advance();
        const Token name = text_.need_word("the name of a value");
        if (!text_.ok()) return {};
        const Operand value = value_of(name, type);
        if (value.valid()) return value;
        Nearest nearest{name.text};
        for (const std::string_view each : type->names) nearest.consider(each);
        text_.fail_unknown(name, "value", nearest, " of the enumeration");
        return {};
    }

    Basis& basis_;
    Reader& text_ = basis_.text;
    Emitter& out_ = basis_.out;
    Values& values_ = basis_.values;
    Scope& scope_ = basis_.scope;
    Peers& peers_ = basis_.peers;
    Behaviours& behaviours_ = basis_.behaviours;
    Calls& calls_;
};

} // namespace tappet::script_detail

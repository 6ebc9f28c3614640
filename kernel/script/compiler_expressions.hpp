// Expressions: values that are known are reckoned while compiling, the others by instructions into the
// scratch.
#pragma once

#include "kernel/script/compiler_names.hpp"

namespace tappet::script_detail {

class Expressions : protected Names {
protected:
    using Names::Names;

    // ---- values

    static constexpr Operand literal_of(TypeId type, std::int64_t whole, double real) noexcept {
        Operand value;
        value.type = type;
        value.literal = true;
        value.whole = whole;
        value.real = real;
        return value;
    }
    static constexpr Operand whole_literal(std::int64_t value) noexcept {
        return literal_of(script_int, value, static_cast<double>(value));
    }
    static constexpr Operand at_place(TypeId type, DataOffset at) noexcept {
        Operand value;
        value.type = type;
        value.at = at;
        return value;
    }
    /// What the instruction just emitted leaves.
    static constexpr Operand made(TypeId type, DataOffset at) noexcept {
        Operand value = at_place(type, at);
        value.simple = true;
        return value;
    }

    /// The bytes of a literal as a value of `type`; false: it is none.
    static constexpr bool encode(const Operand& value, TypeId type, std::byte* into) noexcept {
        switch (type->kind) {
        case ValueKind::truth:
            if (value.type != script_bool) return false;
            store_value(into, value.whole != 0);
            return true;
        case ValueKind::whole:
        case ValueKind::natural: {
            if (value.type != script_int) return false;
            const bool is_signed = type->kind == ValueKind::whole;
            const std::size_t bits = 8 * type->size - (is_signed ? 1 : 0);
            if (value.whole < 0 && (!is_signed || (bits < 63 && value.whole < -(std::int64_t{1} << bits))))
                return false;
            if (value.whole >= 0 && bits < 63 && value.whole >> bits != 0) return false;
            for (std::size_t i = 0; i < type->size; ++i)
                into[i] = static_cast<std::byte>(static_cast<std::uint64_t>(value.whole) >> (8 * i));
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
            store_value(into, value.whole);
            return true;
        case ValueKind::enumeration:
            if (value.type != type) return false;
            for (std::size_t i = 0; i < type->size; ++i)
                into[i] = static_cast<std::byte>(static_cast<std::uint64_t>(value.whole) >> (8 * i));
            return true;
        case ValueKind::text: {
            if (value.type != script_text) return false;
            std::size_t used = 0;
            for (std::size_t i = 0; i < value.text.size(); ++i) {
                char letter = value.text[i];
                if (letter == '\\' && i + 1 < value.text.size()) {
                    letter = value.text[++i];
                    if (letter == 'n')
                        letter = '\n';
                    else if (letter == 't')
                        letter = '\t';
                }
                if (used == type->columns) return false;
                into[used++] = static_cast<std::byte>(letter);
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
    /// The value as one of exactly this type, in the data.
    constexpr Operand as(const Token& at, const Operand& value, TypeId type, std::string_view where) {
        if (!ok()) return {};
        if (value.literal) return constant(at, value, type, where);
        if (value.type == type) return value;
        const Conversion conversion = find_conversion(value.type, type);
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
    /// The value in the data, of the type it has.
    constexpr Operand in_data(const Token& at, const Operand& value) {
        return value.literal ? constant(at, value, value.type, "") : value;
    }
    /// C++ numbers of any width become those that scripts reckon with.
    constexpr Operand reckoned(const Token& at, const Operand& value) {
        if (!ok() || value.literal) return value;
        const TypeId type = script_type(value.type);
        return type == value.type ? value : as(at, value, type, "");
    }
    /// to = value, converted to the type of the place.
    constexpr void store(const Token& at, const Operand& value, TypeId type, DataOffset to,
                         std::string_view where) {
        if (!ok()) return;
        if (!value.literal && value.type != type) {
            const Conversion conversion = find_conversion(value.type, type);
            if (!conversion || !conversion.implicit) return fail_type(at, value.type, type_name(type), where);
            convert(conversion, value, type, to);
            return;
        }
        const Operand ready = as(at, value, type, where);
        if (!ok()) return;
        // A number is made where it belongs; what is larger might still be read while it is made.
        if (ready.simple && type->size <= 8 && last_instruction().to == ready.at) {
            last_instruction().to = to;
            return;
        }
        Instruction in = copy_instruction(type);
        in.to = to;
        in.a = ready.at;
        emit(in);
    }

    // ---- the grammar's expressions, one function a level

    /// `expected` gives names of enumerations their meaning.
    constexpr Operand parse_expression(TypeId expected = nullptr) {
        if (!enter()) return {};
        Operand value = parse_binary(0, expected);
        if (ok() && is(Sign::question)) value = parse_choice(value, expected);
        leave();
        return value;
    }
    constexpr Operand parse_condition() {
        const Token at = token_;
        const Operand value = parse_expression(script_bool);
        if (ok() && script_type(value.type) != script_bool)
            fail_type(at, value.type, "a condition of type bool", "");
        return value;
    }
    /// A value that is known while compiling.
    constexpr Operand parse_known(TypeId expected, std::string_view what) {
        const Token at = token_;
        const std::uint16_t before = instruction_count();
        const Operand value = parse_expression(expected);
        if (ok() && (instruction_count() != before || !(value.literal || value.constant)))
            fail(at, {what, " is known before the machine runs; write numbers, texts or constants"});
        return value;
    }
    constexpr bool enter() {
        if (nesting_ == script_max_depth)
            fail(token_, {"this is nested deeper than scripts may be; take parts of it out into variables or "
                          "functions"});
        if (!ok()) return false;
        ++nesting_;
        return true;
    }
    constexpr void leave() { --nesting_; }

private:
    constexpr Operand parse_choice(const Operand& condition, TypeId expected) {
        const Token at = token_;
        advance();
        if (condition.type != script_bool) {
            fail_type(at, condition.type, "a condition of type bool", " before ?");
            return {};
        }
        const Operand asked = in_data(at, condition);
        const std::uint16_t first_skip = instruction_count();
        emit(skip_instruction(true, 0));
        Token where = token_;
        const Operand one = reckoned(where, parse_binary(0, expected));
        if (!ok()) return {};
        const DataOffset to = scratch(one.type->size);
        store(where, one, one.type, to, "");
        finish_skip(first_skip, asked.at);
        if (!need(Sign::colon, "\":\" and the other value")) return {};
        const std::uint16_t second_skip = instruction_count();
        emit(skip_instruction(false, 0));
        where = token_;
        const Operand other = parse_expression(one.type);
        store(where, other, one.type, to, " as before the \":\"");
        finish_skip(second_skip, asked.at);
        return at_place(one.type, to);
    }
    constexpr void finish_skip(std::uint16_t number, DataOffset condition) {
        if (!ok()) return;
        Instruction& skip = instructions_[number];
        skip.a = condition;
        skip.size = static_cast<std::uint16_t>(instruction_count() - number - 1);
    }

    struct Level {
        Operator op = Operator::add;
        int binds = -1; ///< the stronger the higher; -1: no operator of two operands
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
            const Level level = level_of(token_.sign);
            if (!ok() || level.binds < weakest) return left;
            if (!enter()) return {};
            const Token at = token_;
            advance();
            if (level.op == Operator::both || level.op == Operator::either) {
                left = parse_logical(at, level, left);
            } else {
                const Operand right =
                    parse_binary(level.binds + 1, left.type != nullptr ? left.type : expected);
                left = ok() ? combine(at, level.op, left, right) : Operand{};
            }
            leave();
        }
    }
    /// The right side is reckoned only when the left one does not decide.
    constexpr Operand parse_logical(const Token& at, Level level, const Operand& left) {
        const bool is_and = level.op == Operator::both;
        if (script_type(left.type) != script_bool) {
            fail_type(at, left.type, "bool", is_and ? " before &&" : " before ||");
            return {};
        }
        const DataOffset to = scratch(1);
        store(at, left, script_bool, to, "");
        const std::uint16_t skip = instruction_count();
        emit(skip_instruction(is_and, 0));
        const Token where = token_;
        const Operand right = parse_binary(level.binds + 1, script_bool);
        store(where, right, script_bool, to, is_and ? " behind &&" : " behind ||");
        finish_skip(skip, to);
        return at_place(script_bool, to);
    }
    constexpr Operand combine(const Token& at, Operator op, const Operand& left, const Operand& right) {
        Operand known;
        if (left.literal && right.literal && fold(op, left, right, known)) return known;
        const OperatorMatch match = find_binary(op, left.type, right.type);
        if (!match) {
            fail(at, {"there is no ", type_name(left.type), " ", to_text(op), " ", type_name(right.type),
                      "; convert one of them, as with double(x)"});
            return {};
        }
        const Operand a = as(at, left, match.a, ""), b = as(at, right, match.b, "");
        return apply(match, a, b);
    }
    constexpr Operand apply(const OperatorMatch& match, const Operand& a, const Operand& b) {
        if (!ok()) return {};
        Instruction in = match.instruction;
        in.to = scratch(match.result->size);
        in.a = a.at;
        in.b = b.at;
        emit(in);
        return made(match.result, in.to);
    }
    /// Numbers and times that are both known; what would fail is left to fail when it runs.
    static constexpr bool fold(Operator op, const Operand& a, const Operand& b, Operand& into) noexcept {
        if (a.type == b.type && (a.type == script_int || a.type == script_duration)) {
            std::int64_t result = 0;
            if (op == Operator::add        ? __builtin_add_overflow(a.whole, b.whole, &result)
                : op == Operator::subtract ? __builtin_sub_overflow(a.whole, b.whole, &result)
                                           : op != Operator::multiply || a.type == script_duration ||
                                                 __builtin_mul_overflow(a.whole, b.whole, &result))
                return false;
            into = literal_of(a.type, result, static_cast<double>(result));
            return true;
        }
        const auto is_number = [](const Operand& x) {
            return x.type == script_int || x.type == script_double;
        };
        if (!is_number(a) || !is_number(b) || (a.type == script_int && b.type == script_int)) return false;
        // No result of these two may be too large: a constant expression has no infinity.
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

    constexpr Operand parse_unary(TypeId expected) {
        if (is(Sign::plus)) advance();
        if (!is(Sign::minus) && !is(Sign::invert)) return parse_postfix(expected);
        if (!enter()) return {};
        const Token at = token_;
        advance();
        const Operand inner = parse_unary(expected);
        leave();
        if (!ok()) return {};
        const bool negates = at.sign == Sign::minus;
        if (inner.literal && negates &&
            (inner.type == script_int || inner.type == script_double || inner.type == script_duration) &&
            inner.whole != std::numeric_limits<std::int64_t>::min())
            return literal_of(inner.type, -inner.whole, -inner.real);
        if (inner.literal && !negates && inner.type == script_bool)
            return literal_of(script_bool, inner.whole == 0, 0);
        const OperatorMatch match = find_unary(negates ? Operator::negate : Operator::invert, inner.type);
        if (!match) {
            fail(at, {"there is no ", negates ? "-" : "!", " of ", type_name(inner.type),
                      negates ? "" : "; compare it with something"});
            return {};
        }
        return apply(match, as(at, inner, match.a, ""), {});
    }

    // ---- parts of values

    constexpr Operand parse_postfix(TypeId expected) {
        Operand value = parse_primary(expected);
        while (ok() && (is(Sign::dot) || is(Sign::open_square))) value = take_part(value);
        return value;
    }

protected:
    /// The field or element behind a dot or bracket of a value; parts of a place are places.
    constexpr Operand take_part(const Operand& whole) {
        const Token at = token_;
        if (whole.literal) {
            fail(at, {"a ", type_name(whole.type), " has no parts"});
            return {};
        }
        if (is(Sign::open_square)) return take_element(whole);
        advance();
        const Token name = need_word("the name of a field");
        if (!ok()) return {};
        const TypeId type = whole.type;
        if (type->kind == ValueKind::record) {
            for (const RecordField& field : type->fields)
                if (field.name == name.text) return part_of(whole, field.type, field.offset());
            Nearest nearest{name.text};
            for (const RecordField& field : type->fields) nearest.consider(field.name);
            fail_unknown(name, "field", nearest, " in the record");
            return {};
        }
        if (type->kind == ValueKind::matrix && type->columns == 1 && name.text.size() == 1) {
            const std::size_t i = name.text[0] == 'w' ? 3 : static_cast<std::size_t>(name.text[0] - 'x');
            if (name.text[0] >= 'w' && name.text[0] <= 'z' && i < type->rows)
                return part_of(whole, type->element, i * type->element->size);
        }
        fail(name, {"a ", type_name(type), " has no \"", quoted(name.text),
                    "\"; fields are those of records, and x, y, z of vectors"});
        return {};
    }

private:
    static constexpr Operand part_of(const Operand& whole, TypeId type, std::size_t offset) noexcept {
        Operand part = at_place(type, moved(whole.at, offset));
        part.constant = whole.constant;
        return part;
    }
    constexpr Operand take_element(const Operand& whole) {
        const Token at = token_;
        const Index index = parse_index(whole.type);
        if (!ok()) return {};
        const TypeId element = whole.type->element;
        if (index.is_known) return part_of(whole, element, index.number * element->size);
        Instruction in = element_read(whole.type);
        if (in.run == nullptr) {
            fail(at, {"a ", type_name(whole.type), " has no elements"});
            return {};
        }
        in.to = scratch(element->size);
        in.a = whole.at;
        in.b = index.at;
        emit(in);
        return made(element, in.to);
    }

protected:
    struct Index {
        bool is_known = false;
        std::size_t number = 0; ///< among the elements as they lie
        DataOffset at = no_data;
    };
    /// "[i]", of a matrix of more rows and columns "[i][j]" or "[i, j]"; counted from 0.
    constexpr Index parse_index(TypeId type) {
        Index index;
        const Token at = token_;
        if (!need(Sign::open_square, "\"[\"")) return index;
        if (type->kind != ValueKind::matrix && type->kind != ValueKind::sequence) {
            fail(at, {"a ", type_name(type), " has no elements"});
            return index;
        }
        const bool is_matrix = type->kind == ValueKind::matrix && type->rows > 1 && type->columns > 1;
        const std::size_t rows = is_matrix                         ? type->rows
                                 : type->kind == ValueKind::matrix ? type->rows * type->columns
                                                                   : type->columns;
        const Operand row = parse_subscript(rows);
        if (!is_matrix) {
            need(Sign::close_square, "\"]\"");
            if (!ok()) return index;
            index.is_known = row.literal && type->kind == ValueKind::matrix;
            index.number = static_cast<std::size_t>(row.whole);
            if (!index.is_known) index.at = in_data(at, row).at;
            return index;
        }
        if (!take(Sign::comma)) {
            need(Sign::close_square, "\"]\"");
            need(Sign::open_square, "\"[\" and the column");
        }
        const Operand column = parse_subscript(type->columns);
        need(Sign::close_square, "\"]\"");
        if (!ok()) return index;
        if (row.literal && column.literal) {
            const auto r = static_cast<std::size_t>(row.whole), c = static_cast<std::size_t>(column.whole);
            index.is_known = true;
            index.number = type->row_major ? r * type->columns + c : c * type->rows + r;
            return index;
        }
        Instruction in = matrix_index(type);
        in.to = scratch(sizeof(ScriptInt));
        in.a = in_data(at, row).at;
        in.b = in_data(at, column).at;
        emit(in);
        index.at = in.to;
        return index;
    }

private:
    constexpr Operand parse_subscript(std::size_t size) {
        const Token at = token_;
        const Operand value = reckoned(at, parse_expression(script_int));
        if (!ok()) return {};
        if (value.type != script_int)
            fail_type(at, value.type, "an int", " as an index");
        else if (value.literal && (value.whole < 0 || value.whole >= static_cast<std::int64_t>(size)))
            fail(at, {"found an index out of range; elements are counted from 0 on, and there are ",
                      Sentence{size}.view()});
        return value;
    }

    // ---- what an expression begins with

    constexpr Operand parse_primary(TypeId expected) {
        const Token at = token_;
        switch (at.sign) {
        case Sign::integer: advance(); return whole_literal(at.whole);
        case Sign::real: advance(); return literal_of(script_double, 0, at.real);
        case Sign::duration: advance(); return literal_of(script_duration, at.whole, 0);
        case Sign::k_true:
        case Sign::k_false: advance(); return literal_of(script_bool, at.sign == Sign::k_true, 0);
        case Sign::text: {
            advance();
            Operand value = literal_of(script_text, 0, 0);
            value.text = at.text;
            return value;
        }
        case Sign::open_round: {
            advance();
            const Operand value = parse_expression(expected);
            need(Sign::close_round, "\")\"");
            return value;
        }
        case Sign::name: advance(); return parse_named(at, expected);
        default: fail_expected("a value"); return {};
        }
    }
    constexpr Operand parse_named(const Token& name, TypeId expected) {
        if (Symbol* const symbol = find_symbol(name); symbol != nullptr) {
            if (symbol->kind == SymbolKind::function) return call_value(name, functions_[symbol->number]);
            if (symbol->kind == SymbolKind::machine) return parse_machine_value(symbol->number);
            return symbol->operand;
        }
        if (is(Sign::open_round)) {
            const std::uint16_t own = find_facet(std::uint16_t{0}, name.text);
            return own != none ? read_facet(name, 0, own) : parse_function(name);
        }
        if (is(Sign::dot)) {
            if (const std::uint16_t component = find_component(name.text); component != none) {
                advance();
                const Token facet_name = need_word("the name of a method, port or property");
                const std::uint16_t facet = ok() ? parse_facet(component, facet_name) : none;
                return facet == none ? Operand{} : read_facet(facet_name, component, facet);
            }
            if (const TypeId type = find_type(name.text);
                type != nullptr && type->kind == ValueKind::enumeration) {
                advance();
                const Token value = need_word("the name of a value");
                return ok() ? value_of(value, type, true) : Operand{};
            }
        }
        if (expected != nullptr && expected->kind == ValueKind::enumeration)
            if (const Operand value = value_of(name, expected, false); value.valid()) return value;
        if (const std::uint16_t own = find_facet(std::uint16_t{0}, name.text); own != none) {
            const std::uint16_t facet = parse_facet(0, name);
            return facet == none ? Operand{} : read_facet(name, 0, facet);
        }
        fail_unknown_value(name, expected);
        return {};
    }
    constexpr Operand value_of(const Token& name, TypeId type, bool must) {
        for (std::size_t i = 0; i < type->names.size(); ++i)
            if (type->names[i] == name.text) return literal_of(type, static_cast<std::int64_t>(i), 0);
        if (must) {
            Nearest nearest{name.text};
            for (const std::string_view each : type->names) nearest.consider(each);
            fail_unknown(name, "value", nearest, " of the enumeration");
        }
        return {};
    }

protected:
    constexpr void fail_unknown_value(const Token& name, TypeId expected) {
        if (!ok()) return;
        Nearest nearest{name.text};
        for (std::size_t i = 0; i < symbols_used_; ++i) nearest.consider(symbols_[i].name);
        for (const Reachable& each : reach_.components) nearest.consider(each.name);
        for (const Facet& each : facets(0)) nearest.consider(each.name);
        if (expected != nullptr)
            for (const std::string_view each : expected->names) nearest.consider(each);
        fail_unknown(name, "name", nearest, "");
    }

private:
    /// A function of the library or of a type, a conversion, or a value put together of its parts.
    constexpr Operand parse_function(const Token& name) {
        if (name.text == "time" || name.text == "elapsed") {
            advance();
            if (!need(Sign::close_round, "\")\"")) return {};
            const FacetAction action = name.text == "time" ? machine_time() : elapsed_time();
            Instruction in = action.instruction;
            in.to = scratch(sizeof(Duration));
            emit(in);
            return made(action.type, in.to);
        }
        if (const TypeId type = find_type(name.text); type != nullptr) return parse_constructor(name, type);
        advance();
        Operand operands[2];
        TypeId types[2] = {};
        std::size_t count = 0;
        while (ok() && !is(Sign::close_round)) {
            if (count == 2) {
                fail(token_, {"\"", quoted(name.text), "\" has at most 2 arguments"});
                return {};
            }
            const Token at = token_;
            operands[count] = reckoned(at, parse_expression());
            types[count] = operands[count].type;
            ++count;
            if (!is(Sign::close_round) && !need(Sign::comma, "\",\" or \")\"")) return {};
        }
        if (!ok() || !need(Sign::close_round, "\")\"")) return {};
        const OperatorMatch match = find_function(name.text, std::span{types}.first(count));
        if (!match) {
            Nearest nearest{name.text};
            bool is_known = false;
            for (const std::string_view each : function_names()) {
                is_known = is_known || each == name.text;
                nearest.consider(each);
            }
            for (std::size_t i = 0; i < functions_used_; ++i) nearest.consider(functions_[i].name);
            for (const Facet& each : facets(0))
                if (each.kind == FacetKind::method) nearest.consider(each.name);
            if (is_known)
                fail(name, {"there is no ", name.text, "(", type_name(types[0]), count > 1 ? ", " : "",
                            count > 1 ? type_name(types[1]) : "", ")"});
            else
                fail_unknown(name, "function", nearest, "");
            return {};
        }
        const Operand a = as(name, operands[0], match.a, "");
        const Operand b = match.b != nullptr ? as(name, operands[1], match.b, "") : Operand{};
        return apply(match, a, b);
    }
    constexpr Operand parse_constructor(const Token& name, TypeId type) {
        advance();
        const bool is_record = type->kind == ValueKind::record, is_matrix = type->kind == ValueKind::matrix;
        if (!is_record && !is_matrix) {
            const Token at = token_;
            const Operand value = reckoned(at, parse_expression());
            if (!need(Sign::close_round, "\")\"")) return {};
            if (value.literal && value.type == script_int && type == script_double)
                return literal_of(script_double, 0, value.real);
            if (value.type == type) return value;
            const Conversion conversion = find_conversion(value.type, type);
            if (!conversion) {
                fail_type(at, value.type, type_name(type), "");
                return {};
            }
            const Operand ready = in_data(at, value);
            return ok() ? convert(conversion, ready, type, scratch(type->size)) : Operand{};
        }
        // Its known parts stand among the constants; those that are not are written into a copy of that.
        Operand whole = at_place(type, no_data);
        static_cast<void>(add_constant(type->size, whole.at));
        whole.constant = true;
        const std::size_t parts = is_record ? type->fields.size() : type->rows * type->columns;
        for (std::size_t i = 0; ok() && i < parts; ++i) {
            if (i != 0 && !need(Sign::comma, "\",\" and a value for each part")) return {};
            const TypeId part = is_record ? type->fields[i].type : type->element;
            // A matrix is written row by row.
            const std::size_t offset =
                is_record ? type->fields[i].offset()
                          : type->element->size *
                                (type->row_major ? i : (i % type->columns) * type->rows + i / type->columns);
            const Token at = token_;
            const Operand value = parse_expression(part);
            if (!ok()) return {};
            if (whole.constant && value.literal) {
                std::byte bytes[8] = {};
                std::byte* const into = room_.image.data() + image_base_ + within(whole.at) + offset;
                if (part->size <= 8 ? !encode(value, part, bytes) : !encode(value, part, into)) {
                    fail_type(at, value.type, type_name(part), "");
                    return {};
                }
                if (part->size <= 8) std::copy_n(bytes, part->size, into);
                continue;
            }
            if (whole.constant) {
                Instruction in = copy_instruction(type);
                in.a = whole.at;
                in.to = whole.at = scratch(type->size);
                whole.constant = false;
                // The value may have been made by the instruction before this one.
                Operand kept = value;
                kept.simple = false;
                emit(in);
                store(at, kept, part, moved(whole.at, offset), "");
                continue;
            }
            store(at, value, part, moved(whole.at, offset), "");
        }
        if (!ok()) return {};
        if (is(Sign::comma)) {
            fail(token_,
                 {"a ", type_name(type), " has ", Sentence{parts}.view(), " parts; leave out what is more"});
            return {};
        }
        static_cast<void>(name);
        need(Sign::close_round, "\")\"");
        return whole;
    }
    /// A function whose body is one return, expanded here.
    constexpr Operand call_value(const Token& name, Function& function) {
        if (!function.is_value) {
            fail(name, {"function \"", function.name, "\" has statements; call it by \"set x = ",
                        function.name, "(...)\" or \"do\" alone, or make one return of it"});
            return {};
        }
        const Expansion expansion = begin_expansion(name, function);
        if (!ok()) return {};
        advance(); // return
        const Token at = token_;
        Operand value = parse_expression(function.result);
        if (function.result != nullptr && ok() && !value.literal)
            value = as(at, value, function.result, " as the function returns");
        end_expansion(function, expansion);
        return value;
    }

protected:
    struct Expansion {
        Place behind{};
        std::size_t symbols = 0;
        std::size_t scope = 0;
        std::size_t hidden_begin = 0;
        std::size_t hidden_end = 0;
    };
    /// Reads the arguments at the call and stands behind the opening brace of the body then. An argument that
    /// is no constant is reckoned once, into the scratch or where `keeps` says.
    constexpr Expansion begin_expansion(const Token& name, Function& function, bool keeps = false) {
        Expansion expansion;
        if (function.expanding)
            fail(name,
                 {"function \"", function.name, "\" calls itself; recursion has no bound, write a loop"});
        if (!enter()) return expansion;
        if (!need(Sign::open_round, "\"(\" and the arguments")) return expansion;
        expansion.symbols = symbols_used_;
        expansion.scope = scope_;
        expansion.hidden_begin = hidden_begin_;
        expansion.hidden_end = hidden_end_;
        Place parameters{function.lexer, function.token};
        while (ok()) { // the caller's text and the function's are read in turns
            const Place call = here();
            go_to(parameters);
            if (is(Sign::close_round)) {
                advance();
                need(Sign::open_brace, "\"{\"");
                parameters = here();
                go_to(call);
                break;
            }
            const TypeId type = parse_type();
            const Token parameter = need_name("the name of a parameter");
            static_cast<void>(take(Sign::comma));
            parameters = here();
            go_to(call);
            const Token at = token_;
            if (is(Sign::close_round) && ok()) {
                fail(token_, {"an argument is missing: \"", quoted(parameter.text), "\" of ", function.name});
                break;
            }
            Operand value = parse_expression(type);
            if (!value.literal && ok()) {
                const DataOffset to = keeps ? place_in(Region::arguments, type->size) : scratch(type->size);
                store(at, value, type, to, " as an argument");
                value = at_place(type, to);
            } else if (ok()) {
                const Operand placed = as(at, value, type, " as an argument");
                if (value.type != type && type->kind != ValueKind::real)
                    value = placed;
                else if (type == script_double)
                    value = literal_of(script_double, 0, value.real);
            }
            Symbol symbol;
            symbol.kind = SymbolKind::value;
            symbol.fixed = true;
            symbol.operand = value;
            symbol.name = parameter.text; // in sight when all arguments are read: until then without its hash
            if (symbols_used_ == symbols_.size())
                fail_room("names in sight at one place");
            else
                symbols_[symbols_used_++] = symbol;
            if (!is(Sign::close_round)) need(Sign::comma, "\",\" or \")\"");
        }
        need(Sign::close_round, "\")\" behind the arguments");
        expansion.behind = here();
        if (!ok()) return expansion;
        for (std::size_t i = expansion.symbols; i < symbols_used_; ++i) {
            const std::uint32_t hash = hash_of(symbols_[i].name);
            symbols_[i].hash = hash != 0 ? hash : 1;
        }
        hidden_begin_ = function.symbols == none ? program_symbols_ : function.symbols;
        hidden_end_ = expansion.symbols;
        scope_ = expansion.symbols;
        function.expanding = true;
        go_to(parameters);
        return expansion;
    }
    constexpr void end_expansion(Function& function, const Expansion& expansion) {
        function.expanding = false;
        leave();
        symbols_used_ = expansion.symbols;
        scope_ = expansion.scope;
        hidden_begin_ = expansion.hidden_begin;
        hidden_end_ = expansion.hidden_end;
        go_to(expansion.behind);
    }

    // ---- what components have

    /// "(a, b)", each converted to the type of the interface and packed at `to`.
    constexpr void parse_arguments(std::span<const TypeId> types, DataOffset to) {
        if (!need(Sign::open_round, "\"(\" and the arguments")) return;
        std::size_t at = 0;
        for (std::size_t i = 0; ok() && i < types.size(); ++i) {
            if (i != 0 && !is(Sign::close_round)) need(Sign::comma, "\",\" or \")\"");
            parse_argument(types[i], moved(to, at), i, types.size());
            at += types[i]->size;
        }
        end_arguments(types.size());
    }
    constexpr void parse_argument(TypeId type, DataOffset to, std::size_t number, std::size_t count) {
        if (!ok()) return;
        const Token at = token_;
        if (is(Sign::close_round))
            return fail(at,
                        {"found ", Sentence{number}.view(), " arguments, expected ", Sentence{count}.view()});
        store(at, parse_expression(type), type, to, " as an argument");
    }
    constexpr void end_arguments(std::size_t count) {
        if (!ok() || take(Sign::close_round)) return;
        if (is(Sign::comma)) return fail(token_, {"found more arguments, expected ", Sentence{count}.view()});
        fail_expected("\")\"");
    }
    constexpr void act(const FacetAction& action, std::uint16_t component, std::uint16_t facet, DataOffset to,
                       DataOffset a) {
        if (!ok()) return;
        Instruction in = action.instruction;
        in.to = to;
        in.a = a;
        in.link = link(component, facet, false);
        emit(in);
    }
    [[nodiscard]] constexpr const Facet& facet_of(std::uint16_t component,
                                                  std::uint16_t facet) const noexcept {
        return facets(component)[facet];
    }
    /// A method in this thread: its own, those of the activity, or one that may be called by any.
    constexpr void check_call(const Token& at, std::uint16_t component, const Facet& facet) {
        check_reach(at, component, facet.name, reach_.operations, "operations");
        if (ok() && !facet.any_thread && !is_near(component))
            fail(at, {"\"", quoted(facet.name), "\" of \"", reach_.components[component].name,
                      "\" is called in its own activity only; make it any_thread, or send a command"});
    }

private:
    constexpr Operand read_facet(const Token& name, std::uint16_t component, std::uint16_t number) {
        const Facet& facet = facet_of(component, number);
        switch (facet.kind) {
        case FacetKind::method: {
            check_call(name, component, facet);
            const FacetAction action = call_method(facet);
            if (ok() && action.type == nullptr)
                fail(name, {"\"", quoted(facet.name), "\" returns nothing; write \"do\" and no value"});
            if (!ok()) return {};
            const DataOffset packed =
                facet.method->argument_bytes != 0 ? scratch(facet.method->argument_bytes) : no_data;
            parse_arguments(facet.type->elements, packed);
            if (!ok()) return {};
            const DataOffset to = scratch(action.type->size);
            act(action, component, number, to, packed);
            return made(action.type, to);
        }
        case FacetKind::property:
        case FacetKind::output:
        case FacetKind::input: {
            check_near(name, component, to_text(facet.kind));
            if (ok() && is(Sign::dot) && facet.kind != FacetKind::property) {
                const Place before = here();
                advance();
                const std::string_view part = token_.text;
                const FacetAction asked = part == "valid"   ? input_valid(facet)
                                          : part == "fresh" ? input_fresh(facet)
                                          : part == "age"   ? port_age(facet)
                                                            : FacetAction{};
                if (part == "value") {
                    advance();
                } else if (asked) {
                    advance();
                    return read_by(asked, component, number);
                } else {
                    go_to(before);
                }
            }
            return read_by(find_read(facet), component, number);
        }
        case FacetKind::buffer_input: {
            check_near(name, component, "a buffer");
            if (!need(Sign::dot, "\".empty\" or \".pop()\" of the buffer")) return {};
            const Token part = need_word("empty or pop");
            if (part.text == "empty") return read_by(buffer_empty(facet), component, number);
            if (part.text != "pop")
                fail(part, {"a buffered input has empty and pop(), not \"", quoted(part.text), "\""});
            need(Sign::open_round, "\"(\"");
            need(Sign::close_round, "\")\"");
            return read_by(pop_buffer(facet), component, number);
        }
        case FacetKind::buffer_output: {
            check_near(name, component, "a buffer");
            need(Sign::dot, "\".push(value)\" of the buffer");
            const Token part = need_word("push");
            if (ok() && part.text != "push")
                fail(part, {"a buffered output has push(value), not \"", quoted(part.text), "\""});
            if (!ok()) return {};
            const DataOffset value = scratch(facet.type->size), to = scratch(1);
            parse_arguments({&facet.type, 1}, value);
            act(push_buffer(facet), component, number, to, value);
            return made(script_bool, to);
        }
        case FacetKind::command:
            fail(name,
                 {"\"", quoted(facet.name), "\" is a command, which takes time; write \"do\" and no value"});
            return {};
        default:
            fail(name, {"\"", quoted(facet.name), "\" is ", to_text(facet.kind), ", which has no value"});
            return {};
        }
    }
    constexpr Operand read_by(const FacetAction& action, std::uint16_t component, std::uint16_t facet) {
        if (!ok() || action.type == nullptr) return {};
        const DataOffset to = scratch(action.type->size);
        act(action, component, facet, to, no_data);
        return made(action.type, to);
    }
    /// What a parent asks of its child machine; in compiler_children.hpp, as what it does with one.
    constexpr Operand parse_machine_value(std::uint16_t child);

protected:
    /// The name of a state of the child, in quotes or without.
    constexpr std::uint16_t parse_child_state(const Child& child) {
        const Token name = token_;
        if (!is(Sign::text) && !token_.is_word()) {
            fail_expected("the name of a state");
            return 0;
        }
        advance();
        const auto states = types_.room[child.type].machine.states;
        for (std::size_t i = 0; i < states.size(); ++i)
            if (states[i].name == name.text) return static_cast<std::uint16_t>(i);
        Nearest nearest{name.text};
        for (const StateRow& each : states) nearest.consider(each.name);
        fail_unknown(name, "state", nearest, " of the child machine");
        return 0;
    }
    constexpr const VariableRow* child_variable(const Child& child, const Token& word) {
        const auto variables = types_.room[child.type].tables.variables;
        for (const VariableRow& each : variables)
            if (each.name == word.text) return &each;
        Nearest nearest{word.text};
        for (const VariableRow& each : variables) nearest.consider(each.name);
        fail_unknown(word, "variable", nearest, " of the child machine");
        return nullptr;
    }
    static constexpr void set_child_place(Instruction& in, const VariableRow& variable) noexcept {
        in.size = static_cast<std::uint16_t>(variable.type->size);
        in.inner = static_cast<std::uint8_t>(variable.at & 0xff);
        in.columns = static_cast<std::uint8_t>(variable.at >> 8);
    }

    std::uint32_t nesting_ = 0;
    std::size_t program_symbols_ = 0; // how many names were in sight before the program in hand
};

} // namespace tappet::script_detail

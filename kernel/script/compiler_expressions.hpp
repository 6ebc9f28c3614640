// Expressions: known values are computed at compile time, others by instructions into the scratch.
#pragma once

#include "kernel/script/compiler_values.hpp"

namespace tappet::script_detail {

class Expressions : protected Values {
protected:
    using Values::Values;

    // ---- the grammar's expressions, one function a level

    /// Parses an expression; `expected` gives names of enumerations their meaning.
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
    /// Parses a value that is known at compile time.
    constexpr Operand parse_known(TypeId expected, std::string_view what) {
        const Token at = token_;
        const std::uint16_t before = instruction_count();
        const Operand value = parse_expression(expected);
        if (ok() && (instruction_count() != before || !(value.literal || value.constant)))
            fail(at, {what, " must be known before the machine runs; write numbers, texts or constants"});
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
    /// The right side is evaluated only when the left one does not decide.
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
        store(where, right, script_bool, to, is_and ? " after &&" : " after ||");
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
    /// Folds two known numbers or times; an operation that would fail is left to fail at run time.
    static constexpr bool fold(Operator op, const Operand& a, const Operand& b, Operand& into) noexcept {
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
        const auto is_number = [](const Operand& x) {
            return x.type == script_int || x.type == script_double;
        };
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
            inner.integer != std::numeric_limits<std::int64_t>::min())
            return inner.type == script_int ? integer_literal(-inner.integer) // integers have no -0
                                            : literal_of(inner.type, -inner.integer, -inner.real);
        if (inner.literal && !negates && inner.type == script_bool)
            return literal_of(script_bool, inner.integer == 0, 0);
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
    /// Parses the field or element after a dot or bracket of a value; a part of a place is a place.
    constexpr Operand take_part(const Operand& integer);

private:
    static constexpr Operand part_of(const Operand& integer, TypeId type, std::size_t offset) noexcept {
        Operand part = at_place(type, moved(integer.at, offset));
        part.constant = integer.constant;
        return part;
    }
    constexpr Operand take_element(const Operand& integer);

protected:
    struct Index {
        bool is_known = false;
        std::size_t number = 0; ///< among the elements in memory order
        DataOffset at = no_data;
    };
    /// "[i]"; for a matrix of several rows and columns "[i][j]" or "[i, j]"; counted from 0.
    constexpr Index parse_index(TypeId type);

private:
    constexpr Operand parse_subscript(std::size_t size);

    // ---- first tokens of an expression

    constexpr Operand parse_primary(TypeId expected) {
        const Token at = token_;
        switch (at.sign) {
        case Sign::integer: advance(); return integer_literal(at.integer);
        case Sign::real: advance(); return literal_of(script_double, 0, at.real);
        case Sign::duration: advance(); return literal_of(script_duration, at.integer, 0);
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
            if (const InstanceIndex program = find_program(name.text); program != no_instance)
                return parse_program_value(program);
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
    /// Parses a function of the library or of a type, a conversion, or a value made of its parts.
    constexpr Operand parse_function(const Token& name);
    constexpr void fail_function(const Token& name, TypeId first, TypeId second);
    constexpr Operand parse_constructor(const Token& name, TypeId type);
    /// Expands a function whose body is one return.
    constexpr Operand call_value(const Token& name, Function& function);

protected:
    struct Expansion {
        Place after{};
        std::size_t symbols = 0;
        std::size_t scope = 0;
        std::size_t hidden_begin = 0;
        std::size_t hidden_end = 0;
    };
    /// Reads the arguments at the call, then continues after the opening brace of the body. A non-constant
    /// argument is computed once, into the scratch or where `keeps` says.
    constexpr Expansion begin_expansion(const Token& name, Function& function, bool keeps = false);
    constexpr void end_expansion(Function& function, const Expansion& expansion);

    // ---- facets of components

    /// Parses "(a, b)": converts each to the type of the interface and packs it at `to`.
    constexpr void parse_arguments(std::span<const TypeId> types, DataOffset to);
    constexpr void parse_argument(TypeId type, DataOffset to, std::size_t number, std::size_t count);
    constexpr void end_arguments(std::size_t count);
    constexpr void act(const FacetAction& action, std::uint16_t component, std::uint16_t facet, DataOffset to,
                       DataOffset a);
    [[nodiscard]] constexpr const Facet& facet_of(std::uint16_t component,
                                                  std::uint16_t facet) const noexcept {
        return facets(component)[facet];
    }
    /// Checks a method call in this thread: its own methods, those of the activity, or any_thread ones.
    constexpr void check_call(const Token& at, std::uint16_t component, const Facet& facet);

private:
    constexpr Operand read_facet(const Token& name, std::uint16_t component, std::uint16_t number);
    constexpr Operand read_method(const Token& name, std::uint16_t component, std::uint16_t number);
    constexpr Operand read_value(const Token& name, std::uint16_t component, std::uint16_t number);
    constexpr Operand read_buffer(const Token& name, std::uint16_t component, std::uint16_t number);
    constexpr Operand push_value(const Token& name, std::uint16_t component, std::uint16_t number);
    constexpr Operand read_by(const FacetAction& action, std::uint16_t component, std::uint16_t facet);
    /// Questions to a child machine; in compiler_children.hpp, like its commands.
    constexpr Operand parse_machine_value(std::uint16_t child);
    /// Questions to a program beside; in compiler_beside.hpp.
    constexpr Operand parse_program_value(InstanceIndex program);

protected:
    [[nodiscard]] constexpr Instruction program_instruction(Primitive run, InstanceIndex program);
    /// Parses ".word()"; returns which word.
    template <class Words> constexpr std::uint8_t parse_program_word(const Words& words,
                                                                     std::string_view wanted);
    /// Parses the name of a state of the child, in quotes or without.
    constexpr std::uint16_t parse_child_state(const Child& child);
    constexpr const VariableRow* child_variable(const Child& child, const Token& word);
    static constexpr void set_child_place(Instruction& in, const VariableRow& variable) noexcept {
        in.size = static_cast<std::uint16_t>(variable.type->size);
        in.inner = static_cast<std::uint8_t>(variable.at & 0xff);
        in.columns = static_cast<std::uint8_t>(variable.at >> 8);
    }

    std::uint32_t nesting_ = 0;
    std::size_t program_symbols_ = 0; // names visible before the current program or member
};

} // namespace tappet::script_detail

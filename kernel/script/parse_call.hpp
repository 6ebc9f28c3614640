// Calls in expressions: facets of components, functions of the library and of the script, constructors.
#pragma once

#include "kernel/script/parse_expression.hpp"

namespace tappet::script_detail {

/// Typed by a user at a browser: values that a line reads stay fresh for components, and an expression
/// changes nothing.
enum class Purpose : std::uint8_t { script, line, line_expression };

class Calls {
public:
    constexpr Calls(Basis& basis, Expressions& expressions) : basis_{basis}, expressions_{expressions} {}

    constexpr void set_purpose(Purpose purpose) noexcept { purpose_ = purpose; }

    // ---- arguments

    /// Parses "(a, b)": converts each to the type of the interface and packs it at `to`.
    constexpr void parse_arguments(std::span<const TypeId> types, DataOffset to) {
        if (!text_.need(Sign::open_round, "\"(\" and the arguments")) return;
        std::size_t at = 0;
        for (std::size_t i = 0; text_.ok() && i < types.size(); ++i) {
            if (i != 0) text_.need_comma();
            parse_argument(types[i], moved(to, at), i, types.size());
            at += types[i]->size;
        }
        end_arguments(types.size());
    }
    /// Parses the argument `number` of `count`.
    constexpr void parse_argument(TypeId type, DataOffset to, std::size_t number, std::size_t count) {
        if (!text_.ok()) return;
        const Token at = text_.token();
        if (text_.is(Sign::close_round))
            return text_.fail(at,
                              {"found ", text_.digits(number), " arguments, expected ", text_.digits(count)});
        values_.store(at, expressions_.parse(type), type, to, " as an argument");
    }
    constexpr void end_arguments(std::size_t count) {
        if (!text_.ok() || text_.take(Sign::close_round)) return;
        if (text_.is(Sign::comma))
            return text_.fail({"found more arguments, expected ", text_.digits(count)});
        text_.fail_expected("\")\"");
    }
    /// Returns a place for `bytes` of packed arguments.
    constexpr DataOffset scratch_for(std::size_t bytes) { return bytes != 0 ? out_.scratch(bytes) : no_data; }

    // ---- facets of components

    constexpr Operand parse_facet_value(const Token& name, PeerFacet facet) {
        switch (facet->kind) {
        case FacetKind::method: return parse_method(name, facet);
        case FacetKind::property:
        case FacetKind::output:
        case FacetKind::input: return parse_port(name, facet);
        case FacetKind::buffer_input: return parse_buffer(name, facet);
        case FacetKind::buffer_output: return parse_push(name, facet);
        case FacetKind::command:
            return values_.fail(name, {"\"", quoted(facet->name),
                                       "\" is a command, which takes time; write \"do\" and no value"});
        default:
            return values_.fail(
                name, {"\"", quoted(facet->name), "\" is ", to_text(facet->kind), ", which has no value"});
        }
    }

    // ---- functions

    /// Expands a function whose body is one return.
    constexpr Operand parse_value(const Token& name, Function& function) {
        if (!function.is_value)
            return values_.fail(name, {"function \"", function.name,
                                       "\" has statements; call it by \"set x = ", function.name,
                                       "(...)\" or \"do\" alone, or make one return of it"});
        const Expansion expansion = begin_expansion(name, function);
        if (!text_.ok()) return {};
        text_.advance(); // return
        const Token at = text_.token();
        Operand value = expressions_.parse(function.result);
        if (function.result != nullptr && text_.ok() && !value.literal)
            value = values_.as(at, value, function.result, " as the function returns");
        end_expansion(function, expansion);
        return value;
    }
    struct Expansion {
        Reader::Place after{};
        Scope::Mark names{};
    };
    /// Reads the arguments at the call, then continues after the opening brace of the body. A non-constant
    /// argument is computed once, into the scratch or where `keeps` says.
    constexpr Expansion begin_expansion(const Token& name, Function& function, bool keeps = false) {
        Expansion expansion;
        if (function.expanding)
            text_.fail(name, {"function \"", function.name,
                              "\" calls itself; recursion has no bound, write a loop"});
        if (!text_.enter()) return expansion;
        if (!text_.need(Sign::open_round, "\"(\" and the arguments")) return expansion;
        expansion.names = scope_.mark();
        Reader::Place parameters = function.parameters;
        while (text_.ok()) { // alternates between the caller's text and the function's
            const Reader::Place call = text_.here();
            text_.go_to(parameters);
            if (text_.take(Sign::close_round)) {
                text_.need(Sign::open_brace, "\"{\"");
                parameters = text_.here();
                text_.go_to(call);
                break;
            }
            const TypeId type = peers_.parse_type();
            const Token parameter = text_.need_name("the name of a parameter");
            text_.skip(Sign::comma);
            parameters = text_.here();
            text_.go_to(call);
            if (text_.is(Sign::close_round) && text_.ok()) {
                text_.fail({"an argument is missing: \"", quoted(parameter.text), "\" of ", function.name});
                break;
            }
            scope_.add_argument(parameter.text, parse_parameter(type, keeps));
            text_.need_comma();
        }
        text_.need(Sign::close_round, "\")\" after the arguments");
        expansion.after = text_.here();
        if (!text_.ok()) return expansion;
        scope_.enter(function, expansion.names.used);
        function.expanding = true;
        text_.go_to(parameters);
        return expansion;
    }
    constexpr void end_expansion(Function& function, const Expansion& expansion) {
        function.expanding = false;
        text_.leave();
        scope_.close(expansion.names);
        text_.go_to(expansion.after);
    }
    /// Parses a function of the library or of a type, a conversion, or a value made of its parts.
    constexpr Operand parse_function(const Token& name) {
        text_.advance();
        if (name.text == "time" || name.text == "elapsed") {
            if (!text_.need(Sign::close_round, "\")\"")) return {};
            const FacetAction action = name.text == "time" ? machine_time() : elapsed_time();
            return made(action.type, out_.emit_to_scratch(action.instruction, sizeof(Duration)));
        }
        if (const TypeId type = peers_.find_type(name.text); type != nullptr)
            return type->kind == ValueKind::record || type->kind == ValueKind::matrix
                       ? parse_parts(type)
                       : parse_conversion(type);
        Operand operands[2];
        TypeId types[2] = {};
        std::size_t count = 0;
        while (text_.ok() && !text_.is(Sign::close_round)) {
            if (count == 2)
                return values_.fail(text_.token(), {"\"", quoted(name.text), "\" has at most 2 arguments"});
            const Token at = text_.token();
            operands[count] = values_.reckoned(at, expressions_.parse());
            types[count] = operands[count].type;
            ++count;
            text_.need_comma();
        }
        if (!text_.ok() || !text_.need(Sign::close_round, "\")\"")) return {};
        const OperatorMatch match = find_function(name.text, std::span{types}.first(count));
        if (!match) {
            fail_function(name, types[0], count > 1 ? types[1] : nullptr);
            return {};
        }
        const Operand a = values_.as(name, operands[0], match.a, "");
        const Operand b = match.b != nullptr ? values_.as(name, operands[1], match.b, "") : Operand{};
        return values_.apply(match, a, b);
    }

private:
    constexpr Operand parse_method(const Token& name, PeerFacet facet) {
        peers_.check_call(name, facet);
        if (text_.ok() && purpose_ == Purpose::line_expression && !facet->method->is_const)
            text_.fail(name, {"\"", quoted(facet->name), "\" may change \"", peers_.name_of(facet),
                              "\", and an expression changes nothing; write \"do\" before it, or make the "
                              "method const"});
        const FacetAction action = call_method(*facet);
        if (text_.ok() && action.type == nullptr)
            text_.fail(name, {"\"", quoted(facet->name), "\" returns nothing; write \"do\" and no value"});
        if (!text_.ok()) return {};
        const DataOffset packed = scratch_for(facet->method->argument_bytes);
        parse_arguments(facet->type->elements, packed);
        return act(action, facet, packed);
    }
    constexpr Operand parse_port(const Token& name, PeerFacet facet) {
        peers_.check_near(name, facet, to_text(facet->kind));
        if (text_.ok() && text_.is(Sign::dot) && facet->kind != FacetKind::property) {
            const Reader::Place before = text_.here();
            text_.advance();
            const std::string_view part = text_.token().text;
            const FacetAction asked = part == "valid"   ? input_valid(*facet)
                                      : part == "fresh" ? input_fresh(*facet)
                                      : part == "age"   ? port_age(*facet)
                                                        : FacetAction{};
            if (part == "value" || asked)
                text_.advance();
            else
                text_.go_to(before);
            if (asked) return act(asked, facet);
        }
        return act(purpose_ == Purpose::script ? find_read(*facet) : find_look(*facet), facet);
    }
    constexpr Operand parse_buffer(const Token& name, PeerFacet facet) {
        peers_.check_near(name, facet, "a buffer");
        if (!text_.need(Sign::dot, "\".empty\" or \".pop()\" of the buffer")) return {};
        const Token part = text_.need_word("empty or pop");
        if (part.text == "empty") return act(buffer_empty(*facet), facet);
        if (part.text != "pop")
            text_.fail(part, {"a buffered input has empty and pop(), not \"", quoted(part.text), "\""});
        if (purpose_ != Purpose::script) peers_.fail_foreign(part, facet, "reads it");
        text_.need(Sign::open_round, "\"(\"");
        text_.need(Sign::close_round, "\")\"");
        return act(pop_buffer(*facet), facet);
    }
    constexpr Operand parse_push(const Token& name, PeerFacet facet) {
        peers_.check_near(name, facet, "a buffer");
        if (purpose_ != Purpose::script) peers_.fail_foreign(name, facet, "writes it");
        text_.need(Sign::dot, "\".push(value)\" of the buffer");
        const Token part = text_.need_word("push");
        if (text_.ok() && part.text != "push")
            text_.fail(part, {"a buffered output has push(value), not \"", quoted(part.text), "\""});
        if (!text_.ok()) return {};
        const DataOffset value = out_.scratch(facet->type->size), to = out_.scratch(1);
        parse_arguments({&facet->type, 1}, value);
        peers_.act(push_buffer(*facet), facet, to, value);
        return made(script_bool, to);
    }
    constexpr Operand act(const FacetAction& action, PeerFacet facet, DataOffset packed = no_data) {
        if (!text_.ok() || action.type == nullptr) return {};
        const DataOffset to = out_.scratch(action.type->size);
        peers_.act(action, facet, to, packed);
        return made(action.type, to);
    }
    /// Parses the argument of a function's parameter.
    constexpr Operand parse_parameter(TypeId type, bool keeps) {
        const Token at = text_.token();
        const Operand value = expressions_.parse(type);
        if (!text_.ok()) return {};
        if (!value.literal) {
            const DataOffset to = out_.place_in(keeps ? Region::arguments : Region::scratch, type->size);
            values_.store(at, value, type, to, " as an argument");
            return at_place(type, to);
        }
        const Operand placed = values_.as(at, value, type, " as an argument");
        if (value.type != type && type->kind != ValueKind::real) return placed;
        return type == script_double ? literal_of(script_double, 0, value.real) : value;
    }
    constexpr void fail_function(const Token& name, TypeId first, TypeId second) {
        Nearest nearest{name.text};
        bool is_known = false;
        for (const std::string_view each : function_names()) {
            is_known = is_known || each == name.text;
            nearest.consider(each);
        }
        for (const Function& each : scope_.functions()) nearest.consider(each.name);
        for (const Facet& each : peers_.facets(0))
            if (each.kind == FacetKind::method) nearest.consider(each.name);
        if (is_known)
            text_.fail(name, {"there is no ", name.text, "(", type_name(first), second != nullptr ? ", " : "",
                              second != nullptr ? type_name(second) : "", ")"});
        else
            text_.fail_unknown(name, "function", nearest, "");
    }
    constexpr Operand parse_conversion(TypeId type) {
        const Token at = text_.token();
        const Operand value = values_.reckoned(at, expressions_.parse());
        if (!text_.need(Sign::close_round, "\")\"")) return {};
        if (value.literal && value.type == script_int && type == script_double)
            return literal_of(script_double, 0, value.real);
        if (value.type == type) return value;
        const Conversion conversion = find_conversion(value.type, type);
        if (!conversion) return values_.fail_type(at, value.type, type_name(type), "");
        const Operand ready = values_.in_data(at, value);
        return text_.ok() ? values_.convert(conversion, ready, type, out_.scratch(type->size)) : Operand{};
    }
    /// Parses the parts of a record or matrix. The known ones are among the constants; the others are
    /// written into a copy of them.
    constexpr Operand parse_parts(TypeId type) {
        Operand whole = at_place(type, no_data);
        static_cast<void>(out_.add_constant(type->size, whole.at));
        whole.constant = true;
        const bool is_record = type->kind == ValueKind::record;
        const std::size_t parts = is_record ? type->fields.size() : type->rows * type->columns;
        for (std::size_t i = 0; text_.ok() && i < parts; ++i) {
            if (i != 0 && !text_.need(Sign::comma, "\",\" and a value for each part")) return {};
            if (is_record) {
                parse_part(whole, type->fields[i].type, type->fields[i].offset());
                continue;
            }
            // A matrix literal is written row by row.
            const std::size_t element =
                type->row_major ? i : (i % type->columns) * type->rows + i / type->columns;
            parse_part(whole, type->element, type->element->size * element);
        }
        if (!text_.ok()) return {};
        if (text_.is(Sign::comma))
            return values_.fail(text_.token(), {"a ", type_name(type), " has ", text_.digits(parts),
                                                " parts; leave out what is more"});
        text_.need(Sign::close_round, "\")\"");
        return whole;
    }
    constexpr void parse_part(Operand& whole, TypeId part, std::size_t offset) {
        const Token at = text_.token();
        Operand value = expressions_.parse(part);
        if (!text_.ok()) return;
        if (whole.constant && value.literal) {
            std::byte bytes[8] = {};
            std::byte* const into = out_.constant_bytes(whole.at) + offset;
            if (!encode(value, part, part->size <= 8 ? bytes : into))
                return static_cast<void>(values_.fail_type(at, value.type, type_name(part), ""));
            if (part->size <= 8) std::copy_n(bytes, part->size, into);
            return;
        }
        if (whole.constant) {
            const DataOffset known = whole.at;
            whole.at = out_.scratch(whole.type->size);
            whole.constant = false;
            value.simple = false; // the copy comes between the instruction that made it and its use
            values_.copy(whole.type, known, whole.at);
        }
        values_.store(at, value, part, moved(whole.at, offset), "");
    }

    Basis& basis_;
    Reader& text_ = basis_.text;
    Emitter& out_ = basis_.out;
    Values& values_ = basis_.values;
    Scope& scope_ = basis_.scope;
    Peers& peers_ = basis_.peers;
    Expressions& expressions_;
    Purpose purpose_ = Purpose::script;
};

constexpr Operand Expressions::parse_named(const Token& name, TypeId expected) {
    if (Symbol* const symbol = scope_.find(name); symbol != nullptr) {
        if (symbol->kind == SymbolKind::function)
            return calls_.parse_value(name, scope_.functions()[symbol->number]);
        if (symbol->kind == SymbolKind::machine) return behaviours_.parse_machine_value(symbol->number);
        return symbol->operand;
    }
    if (text_.is(Sign::open_round)) {
        const PeerFacet own = peers_.find_facet(0, name.text);
        return own ? calls_.parse_facet_value(name, own) : calls_.parse_function(name);
    }
    if (text_.is(Sign::dot)) {
        if (const std::uint16_t component = peers_.find(name.text); component != none) {
            text_.advance();
            const Token facet_name = text_.need_word("the name of a method, port or property");
            const PeerFacet facet = peers_.parse_facet(component, facet_name);
            return facet ? calls_.parse_facet_value(facet_name, facet) : Operand{};
        }
        if (const TypeId type = peers_.find_type(name.text);
            type != nullptr && type->kind == ValueKind::enumeration)
            return parse_value_of(type);
        if (const InstanceIndex program = behaviours_.find_program(name.text); program != no_instance)
            return behaviours_.parse_program_value(program);
    }
    if (expected != nullptr && expected->kind == ValueKind::enumeration)
        if (const Operand value = value_of(name, expected); value.valid()) return value;
    if (peers_.find_facet(0, name.text)) {
        const PeerFacet facet = peers_.parse_facet(0, name);
        return facet ? calls_.parse_facet_value(name, facet) : Operand{};
    }
    fail_unknown(name, expected);
    return {};
}

} // namespace tappet::script_detail

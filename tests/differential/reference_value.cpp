// Evaluates expressions.
#include "tests/differential/reference_program.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <limits>

namespace tappet::reference {
namespace {

__extension__ using Wide = __int128;

std::optional<Value> whole(Wide value) {
    if (value < std::numeric_limits<std::int64_t>::min() || value > std::numeric_limits<std::int64_t>::max())
        return std::nullopt;
    return Value{static_cast<std::int64_t>(value)};
}

std::optional<Value> span(Wide value) {
    const std::optional<Value> ns = whole(value);
    if (!ns) return std::nullopt;
    return Value{Span{std::get<std::int64_t>(*ns)}};
}

template <class T>
std::optional<Value> compare(const std::string& sign, const T& a, const T& b) {
    if (sign == "==") return Value{a == b};
    if (sign == "!=") return Value{a != b};
    if (sign == "<") return Value{a < b};
    if (sign == ">") return Value{a > b};
    if (sign == "<=") return Value{a <= b};
    if (sign == ">=") return Value{a >= b};
    return std::nullopt;
}

bool is_comparison(const std::string& sign) {
    return sign == "==" || sign == "!=" || sign == "<" || sign == ">" || sign == "<=" || sign == ">=";
}

std::optional<Value> wholes(const std::string& sign, std::int64_t a, std::int64_t b) {
    const Wide x = a;
    const Wide y = b;
    if (is_comparison(sign)) return compare(sign, a, b);
    if (sign == "+") return whole(x + y);
    if (sign == "-") return whole(x - y);
    if (sign == "*") return whole(x * y);
    if (b == 0) return std::nullopt;
    return sign == "/" ? whole(x / y) : whole(x % y);
}

std::optional<Value> reals(const std::string& sign, double a, double b) {
    if (is_comparison(sign)) return compare(sign, a, b);
    if (sign == "+") return Value{a + b};
    if (sign == "-") return Value{a - b};
    if (sign == "*") return Value{a * b};
    return Value{a / b};
}

double real_of(const Value& value) {
    if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
    return std::get<double>(value);
}

bool is_number(const Value& value) {
    return std::holds_alternative<std::int64_t>(value) || std::holds_alternative<double>(value);
}

std::optional<Value> spans(const std::string& sign, const Value& a, const Value& b) {
    const auto* x = std::get_if<Span>(&a);
    const auto* y = std::get_if<Span>(&b);
    if (x != nullptr && y != nullptr) {
        if (is_comparison(sign)) return compare(sign, x->ns, y->ns);
        if (sign == "+") return span(Wide{x->ns} + y->ns);
        if (sign == "-") return span(Wide{x->ns} - y->ns);
    }
    if (x != nullptr && std::holds_alternative<std::int64_t>(b)) {
        const std::int64_t n = std::get<std::int64_t>(b);
        if (sign == "*") return span(Wide{x->ns} * n);
        if (sign == "/") return n == 0 ? std::nullopt : span(Wide{x->ns} / n);
    }
    if (y != nullptr && std::holds_alternative<std::int64_t>(a) && sign == "*")
        return span(Wide{y->ns} * std::get<std::int64_t>(a));
    std::cerr << "the reference knows no '" << sign << "' of times\n";
    std::abort();
}

std::optional<Value> vectors(const std::string& sign, const Value& a, const Value& b) {
    const auto* x = std::get_if<Vector>(&a);
    const auto* y = std::get_if<Vector>(&b);
    Vector made = x != nullptr ? *x : *y;
    for (std::size_t i = 0; i < made.size(); ++i) {
        if (x != nullptr && y != nullptr)
            made[i] = sign == "+" ? (*x)[i] + (*y)[i] : (*x)[i] - (*y)[i];
        else if (x != nullptr)
            made[i] = sign == "*" ? (*x)[i] * real_of(b) : (*x)[i] / real_of(b);
        else
            made[i] = real_of(a) * (*y)[i];
    }
    if (sign == "==" || sign == "!=") return Value{(*x == *y) == (sign == "==")};
    return Value{made};
}

std::optional<Value> binary(const std::string& sign, const Value& a, const Value& b) {
    if (std::holds_alternative<Vector>(a) || std::holds_alternative<Vector>(b)) return vectors(sign, a, b);
    if (std::holds_alternative<Span>(a) || std::holds_alternative<Span>(b)) return spans(sign, a, b);
    if (is_number(a)) {
        if (std::holds_alternative<std::int64_t>(a) && std::holds_alternative<std::int64_t>(b))
            return wholes(sign, std::get<std::int64_t>(a), std::get<std::int64_t>(b));
        return reals(sign, real_of(a), real_of(b));
    }
    return compare(sign, std::get<bool>(a), std::get<bool>(b));
}

std::optional<Value> unary(const std::string& sign, const Value& a) {
    if (sign == "!") return Value{!std::get<bool>(a)};
    if (sign == "+") return a;
    if (const auto* number = std::get_if<std::int64_t>(&a)) return whole(-Wide{*number});
    if (const auto* time = std::get_if<Span>(&a)) return span(-Wide{time->ns});
    if (const auto* vector = std::get_if<Vector>(&a)) {
        Vector made = *vector;
        for (double& each : made) each = -each;
        return Value{made};
    }
    return Value{-std::get<double>(a)};
}

/// Mathematical functions; nothing: the name is none of them.
std::optional<std::optional<Value>> mathematics(const std::string& name, const std::vector<Value>& given) {
    const bool whole_numbers = !given.empty() && std::holds_alternative<std::int64_t>(given[0]) &&
                               (given.size() == 1 || std::holds_alternative<std::int64_t>(given[1]));
    if (whole_numbers && name == "abs") {
        const std::int64_t a = std::get<std::int64_t>(given[0]);
        return whole(a < 0 ? -Wide{a} : Wide{a});
    }
    if (whole_numbers && (name == "min" || name == "max")) {
        const std::int64_t a = std::get<std::int64_t>(given[0]);
        const std::int64_t b = std::get<std::int64_t>(given[1]);
        return Value{name == "min" ? std::min(a, b) : std::max(a, b)};
    }
    if (given.empty() || !is_number(given[0])) return std::nullopt;
    const double a = real_of(given[0]);
    if (given.size() == 2) {
        const double b = real_of(given[1]);
        if (name == "min") return Value{std::min(a, b)};
        if (name == "max") return Value{std::max(a, b)};
        if (name == "atan2") return Value{std::atan2(a, b)};
        if (name == "pow") return Value{std::pow(a, b)};
        return std::nullopt;
    }
    constexpr std::pair<std::string_view, double (*)(double)> functions[] = {
        {"abs", [](double x) { return std::fabs(x); }},    {"sqrt", [](double x) { return std::sqrt(x); }},
        {"sin", [](double x) { return std::sin(x); }},     {"cos", [](double x) { return std::cos(x); }},
        {"floor", [](double x) { return std::floor(x); }}, {"ceil", [](double x) { return std::ceil(x); }},
        {"round", [](double x) { return std::round(x); }}, {"exp", [](double x) { return std::exp(x); }},
        {"log", [](double x) { return std::log(x); }}};
    for (const auto& [known, function] : functions)
        if (known == name) return Value{function(a)};
    return std::nullopt;
}

std::optional<Value> element(const Value& of, const Value& at) {
    const auto& vector = std::get<Vector>(of);
    const std::int64_t index = std::get<std::int64_t>(at);
    if (index < 0 || index >= static_cast<std::int64_t>(vector.size())) return std::nullopt;
    return Value{vector[static_cast<std::size_t>(index)]};
}

std::optional<Value> named(Scope& scope, const std::string& name) {
    if (name == result_of_call) return scope.run->result();
    const std::string variable = name.substr(0, name.find('.'));
    if (const Variables* const holder = scope.holder(variable)) {
        const Value& value = holder->values.at(variable);
        if (variable == name) return value;
        const Record& record = std::get<Record>(value);
        return name.ends_with(".x") ? Value{record.x} : Value{record.turns};
    }
    return scope.world->read(name);
}

std::optional<Value> called(Scope& scope, const Expression& expression) {
    std::vector<Value> given;
    for (const Expression& part : expression.parts) {
        const std::optional<Value> value = evaluate(scope, part);
        if (!value) return std::nullopt;
        given.push_back(*value);
    }
    if (const auto result = mathematics(expression.text, given)) return *result;
    if (const Function* const function = scope.function(expression.text)) {
        count("function in an expression");
        Variables parameters;
        for (std::size_t i = 0; i < given.size(); ++i)
            parameters.declare(function->parameters[i].name, function->parameters[i].type,
                               *convert(given[i], function->parameters[i].type));
        scope.given.push_back(&parameters);
        const std::optional<Value> result = evaluate(scope, function->body[0].expressions[0]);
        scope.given.pop_back();
        return result ? convert(*result, function->result) : std::nullopt;
    }
    if (expression.text == "Place") {
        count("record put together");
        const std::optional<std::int64_t> turns = turns_of(given[1]);
        if (!turns) return std::nullopt;
        return Value{Record{real_of(given[0]), *turns}};
    }
    return scope.world->call(expression.text, given);
}

} // namespace

std::optional<Value> evaluate(Scope& scope, const Expression& expression) {
    switch (expression.kind) {
    case Expression::Kind::literal: return expression.value;
    case Expression::Kind::name: return named(scope, expression.text);
    case Expression::Kind::call: return called(scope, expression);
    case Expression::Kind::unary: {
        const std::optional<Value> a = evaluate(scope, expression.parts[0]);
        return a ? unary(expression.text, *a) : std::nullopt;
    }
    default: break;
    }
    const std::optional<Value> a = evaluate(scope, expression.parts[0]);
    if (!a) return std::nullopt;
    if (expression.text == "&&" && !std::get<bool>(*a)) return a;
    if (expression.text == "||" && std::get<bool>(*a)) return a;
    const std::optional<Value> b = evaluate(scope, expression.parts[1]);
    if (!b || expression.text == "&&" || expression.text == "||") return b;
    return expression.kind == Expression::Kind::element ? element(*a, *b) : binary(expression.text, *a, *b);
}

std::optional<Value> convert(const Value& value, const std::string& type) {
    if (type == "double" && std::holds_alternative<std::int64_t>(value)) return Value{real_of(value)};
    return value;
}

std::optional<std::int64_t> turns_of(const Value& value) {
    const std::int64_t number = std::get<std::int64_t>(value);
    if (number < std::numeric_limits<std::int32_t>::min() ||
        number > std::numeric_limits<std::int32_t>::max())
        return std::nullopt;
    return number;
}

Value zero_of(const std::string& type) {
    if (type == "bool") return false;
    if (type == "int") return std::int64_t{0};
    if (type == "double") return 0.0;
    if (type == "Duration") return Span{};
    if (type == "vector3") return Vector(3, 0.0);
    if (type == "Place") return Record{};
    if (type == "text") return std::string{};
    std::cerr << "the reference knows no type '" << type << "'\n";
    std::abort();
}

std::string print(const Value& value) {
    struct Printer {
        std::string operator()(std::monostate) const { return "nothing"; }
        std::string operator()(bool v) const { return v ? "true" : "false"; }
        std::string operator()(std::int64_t v) const { return std::to_string(v); }
        std::string operator()(double v) const {
            if (v != v) return "nan";
            std::array<char, 40> text{};
            std::snprintf(text.data(), text.size(), "%.17g", v);
            return text.data();
        }
        std::string operator()(Span v) const { return std::to_string(v.ns) + "ns"; }
        std::string operator()(const Vector& v) const {
            std::string text = "[";
            for (double each : v) text += (*this)(each) + " ";
            return text + "]";
        }
        std::string operator()(const std::string& v) const { return v; }
        std::string operator()(const Record& v) const {
            return "{" + (*this)(v.x) + " " + std::to_string(v.turns) + " }";
        }
    };
    return std::visit(Printer{}, value);
}

} // namespace tappet::reference

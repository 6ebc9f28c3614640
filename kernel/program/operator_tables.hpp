// The tables of scalar operators for operators.hpp.
#pragma once

#include "kernel/program/operator_kinds.hpp"
#include "kernel/program/primitives_scalar.hpp"

namespace tappet {

namespace detail {

// ---- scalars

struct BinaryRow {
    Operator op;
    TypeId a;
    TypeId b;
    TypeId result;
    Primitive run;
};
struct UnaryRow {
    Operator op;
    TypeId a;
    TypeId result;
    Primitive run;
};
struct FunctionRow {
    std::string_view name;
    TypeId a;
    TypeId b; ///< null: one operand
    TypeId result;
    Primitive run;
};
struct ConversionRow {
    TypeId from;
    TypeId to;
    Primitive run;
    bool implicit;
};

template <class A, class B, class R, bool (*F)(A, B, R&) noexcept TAPPET_REALTIME>
inline constexpr Primitive of_two = &primitive::binary<A, B, R, F>;
template <class A, class R, bool (*F)(A, R&) noexcept TAPPET_REALTIME>
inline constexpr Primitive of_one = &primitive::unary<A, R, F>;
template <class A, class B, bool (*F)(A, B, Duration&) noexcept TAPPET_REALTIME>
inline constexpr Primitive times = &primitive::binary<A, B, Duration, F>;
template <class T, bool (*F)(T, T, bool&) noexcept TAPPET_REALTIME>
inline constexpr Primitive order = &primitive::binary<T, T, bool, F>;

// clang-format off
inline constexpr BinaryRow binary_rows[] = {
    {Operator::add,       script_int, script_int, script_int, of_two<ScriptInt, ScriptInt, ScriptInt, &primitive::add_integer>},
    {Operator::subtract,  script_int, script_int, script_int, of_two<ScriptInt, ScriptInt, ScriptInt, &primitive::subtract_integer>},
    {Operator::multiply,  script_int, script_int, script_int, of_two<ScriptInt, ScriptInt, ScriptInt, &primitive::multiply_integer>},
    {Operator::divide,    script_int, script_int, script_int, of_two<ScriptInt, ScriptInt, ScriptInt, &primitive::divide_integer>},
    {Operator::remainder, script_int, script_int, script_int, of_two<ScriptInt, ScriptInt, ScriptInt, &primitive::remainder_integer>},
    {Operator::equal,     script_int, script_int, script_bool, order<ScriptInt, &primitive::equal>},
    {Operator::unequal,   script_int, script_int, script_bool, order<ScriptInt, &primitive::unequal>},
    {Operator::less,      script_int, script_int, script_bool, order<ScriptInt, &primitive::less>},
    {Operator::at_most,   script_int, script_int, script_bool, order<ScriptInt, &primitive::at_most>},
    {Operator::greater,   script_int, script_int, script_bool, order<ScriptInt, &primitive::greater>},
    {Operator::at_least,  script_int, script_int, script_bool, order<ScriptInt, &primitive::at_least>},

    {Operator::add,       script_double, script_double, script_double, of_two<double, double, double, &primitive::add_real>},
    {Operator::subtract,  script_double, script_double, script_double, of_two<double, double, double, &primitive::subtract_real>},
    {Operator::multiply,  script_double, script_double, script_double, of_two<double, double, double, &primitive::multiply_real>},
    {Operator::divide,    script_double, script_double, script_double, of_two<double, double, double, &primitive::divide_real>},
    {Operator::equal,     script_double, script_double, script_bool, order<double, &primitive::equal>},
    {Operator::unequal,   script_double, script_double, script_bool, order<double, &primitive::unequal>},
    {Operator::less,      script_double, script_double, script_bool, order<double, &primitive::less>},
    {Operator::at_most,   script_double, script_double, script_bool, order<double, &primitive::at_most>},
    {Operator::greater,   script_double, script_double, script_bool, order<double, &primitive::greater>},
    {Operator::at_least,  script_double, script_double, script_bool, order<double, &primitive::at_least>},

    {Operator::add,       script_duration, script_duration, script_duration, times<Duration, Duration, &primitive::add_integer>},
    {Operator::subtract, script_duration, script_duration, script_duration, times<Duration, Duration, &primitive::subtract_integer>},
    {Operator::multiply, script_duration, script_int, script_duration, of_two<Duration, ScriptInt, Duration, &primitive::multiply_integer>},
    {Operator::multiply, script_int, script_duration, script_duration, of_two<ScriptInt, Duration, Duration, &primitive::multiply_integer>},
    {Operator::multiply,  script_duration, script_double,   script_duration, of_two<Duration, double, Duration, &primitive::scale_time>},
    {Operator::multiply,  script_double,   script_duration, script_duration, of_two<double, Duration, Duration, &primitive::scale_by_time>},
    {Operator::divide, script_duration, script_int, script_duration, of_two<Duration, ScriptInt, Duration, &primitive::divide_integer>},
    {Operator::divide,    script_duration, script_double,   script_duration, of_two<Duration, double, Duration, &primitive::shrink_time>},
    {Operator::divide, script_duration, script_duration, script_double,  of_two<Duration, Duration, double, &primitive::ratio_of_times>},
    {Operator::remainder, script_duration, script_duration, script_duration, times<Duration, Duration, &primitive::remainder_integer>},
    {Operator::equal,     script_duration, script_duration, script_bool, order<Duration, &primitive::equal>},
    {Operator::unequal,   script_duration, script_duration, script_bool, order<Duration, &primitive::unequal>},
    {Operator::less,      script_duration, script_duration, script_bool, order<Duration, &primitive::less>},
    {Operator::at_most,   script_duration, script_duration, script_bool, order<Duration, &primitive::at_most>},
    {Operator::greater,   script_duration, script_duration, script_bool, order<Duration, &primitive::greater>},
    {Operator::at_least,  script_duration, script_duration, script_bool, order<Duration, &primitive::at_least>},

    {Operator::equal,   script_bool, script_bool, script_bool, order<bool, &primitive::equal>},
    {Operator::unequal, script_bool, script_bool, script_bool, order<bool, &primitive::unequal>},
    {Operator::both,    script_bool, script_bool, script_bool, order<bool, &primitive::both>},
    {Operator::either,  script_bool, script_bool, script_bool, order<bool, &primitive::either>},
};

inline constexpr UnaryRow unary_rows[] = {
    {Operator::negate, script_int,      script_int,      of_one<ScriptInt, ScriptInt, &primitive::negate_integer>},
    {Operator::negate, script_double,   script_double,   of_one<double, double, &primitive::negate_real>},
    {Operator::negate, script_duration, script_duration, of_one<Duration, Duration, &primitive::negate_integer>},
    {Operator::invert, script_bool,     script_bool,     of_one<bool, bool, &primitive::invert>},
};

template <double (*F)(double)>
inline constexpr Primitive real = &primitive::unary<double, double, &primitive::real_function<F>>;
template <double (*F)(double, double)>
inline constexpr Primitive real2 = &primitive::binary<double, double, double, &primitive::real_function2<F>>;
template <class T>
inline constexpr Primitive least = &primitive::binary<T, T, T, &primitive::lesser_of<T>>;
template <class T>
inline constexpr Primitive most = &primitive::binary<T, T, T, &primitive::greater_of<T>>;
template <class T>
inline constexpr Primitive absolute = &primitive::unary<T, T, &primitive::absolute_integer<T>>;

/// Only part of <cmath>: each inverse takes tens of kB of firmware, and atan2 and sqrt replace them.
inline constexpr FunctionRow function_rows[] = {
    {"abs",   script_int,      nullptr, script_int,      absolute<ScriptInt>},
    {"abs",   script_double,   nullptr, script_double,   real<&std::fabs>},
    {"abs",   script_duration, nullptr, script_duration, absolute<Duration>},
    {"min",   script_int,      script_int,      script_int,      least<ScriptInt>},
    {"min",   script_double,   script_double,   script_double,   least<double>},
    {"min",   script_duration, script_duration, script_duration, least<Duration>},
    {"max",   script_int,      script_int,      script_int,      most<ScriptInt>},
    {"max",   script_double,   script_double,   script_double,   most<double>},
    {"max",   script_duration, script_duration, script_duration, most<Duration>},
    {"sqrt",  script_double, nullptr, script_double, real<&std::sqrt>},
    {"sin",   script_double, nullptr, script_double, real<&std::sin>},
    {"cos",   script_double, nullptr, script_double, real<&std::cos>},
    {"atan2", script_double, script_double, script_double, real2<&std::atan2>},
    {"floor", script_double, nullptr, script_double, real<&std::floor>},
    {"ceil",  script_double, nullptr, script_double, real<&std::ceil>},
    {"round", script_double, nullptr, script_double, real<&std::round>},
    {"exp",   script_double, nullptr, script_double, real<&std::exp>},
    {"log",   script_double, nullptr, script_double, real<&std::log>},
    {"pow",   script_double, script_double, script_double, real2<&std::pow>},
    {"seconds",  script_duration, nullptr, script_double,   of_one<Duration, double, &primitive::time_to_seconds>},
    {"duration", script_double,   nullptr, script_duration, of_one<double, Duration, &primitive::seconds_to_time>},
};

inline constexpr std::string_view known_functions[] = {
    "abs",   "min", "max", "sqrt",    "sin",      "cos",  "atan2", "floor", "ceil",
    "round", "exp", "log", "pow",     "seconds",  "duration", "norm", "dot", "cross", "transpose", "size", "int", "double"};

inline constexpr ConversionRow conversion_rows[] = {
    {script_int,    script_double, of_one<ScriptInt, double, &primitive::integer_to_real>, true},
    {script_double, script_int,    of_one<double, ScriptInt, &primitive::real_to_integer>, false},
    {script_bool,   script_int,    of_one<bool, ScriptInt, &primitive::boolean_to_integer>,  false},
};
// clang-format on

/// By size in bytes, from 1 to 8, signed ones first.
template <class Stored>
inline constexpr Primitive widening = &primitive::unary<Stored, ScriptInt, &primitive::widen<Stored>>;
template <class Stored>
inline constexpr Primitive narrowing = &primitive::unary<ScriptInt, Stored, &primitive::narrow<Stored>>;
inline constexpr Primitive widenings[] = {
    widening<std::int8_t>,  widening<std::int16_t>,  widening<std::int32_t>,  widening<std::int64_t>,
    widening<std::uint8_t>, widening<std::uint16_t>, widening<std::uint32_t>, widening<std::uint64_t>};
inline constexpr Primitive narrowings[] = {
    narrowing<std::int8_t>,  narrowing<std::int16_t>,  narrowing<std::int32_t>,  narrowing<std::int64_t>,
    narrowing<std::uint8_t>, narrowing<std::uint16_t>, narrowing<std::uint32_t>, narrowing<std::uint64_t>};

constexpr std::size_t width_index(TypeId type, bool natural) noexcept {
    const std::size_t width = type->size == 1 ? 0 : type->size == 2 ? 1 : type->size == 4 ? 2 : 3;
    return width + (natural ? 4 : 0);
}
constexpr bool is_integer(TypeId type) noexcept {
    return type->kind == ValueKind::integer || type->kind == ValueKind::natural;
}
constexpr bool is_float(TypeId type) noexcept {
    return type->kind == ValueKind::real && type->size == sizeof(float);
}

} // namespace detail

} // namespace tappet

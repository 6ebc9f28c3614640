// Expressions of scripts (thesis 5.1.4): which instruction computes an operator, a function or a conversion,
// and what it answers, also while the C++ compiler runs.
#include "kernel/program/operators.hpp"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <optional>

namespace operators_test {

struct Pose {
    double x = 0;
    double turn = 0;
};
constexpr Pose add(const Pose& a, const Pose& b) noexcept TAPPET_REALTIME {
    return {a.x + b.x, a.turn + b.turn};
}
constexpr Pose times(const Pose& a, double factor) noexcept TAPPET_REALTIME {
    return {a.x * factor, a.turn * factor};
}
constexpr Pose inverse(const Pose& a) noexcept TAPPET_REALTIME { return {-a.x, -a.turn}; }
enum class Colour : std::uint8_t { red, green };

} // namespace operators_test

template <>
inline constexpr tappet::Registered<tappet::Op<"+", &operators_test::add>,
                                    tappet::Op<"*", &operators_test::times>,
                                    tappet::Op<"inverse", &operators_test::inverse>>
    tappet::operators_of<operators_test::Pose>{};
template <>
inline constexpr auto tappet::names_of<operators_test::Colour> =
    std::array<std::string_view, 2>{"red", "green"};

namespace operators_test {

using namespace tappet;

/// Memory of a program: values at 16-byte places.
struct Data {
    alignas(16) std::byte bytes[512]{};
    template <class T>
    void put(std::size_t place, const T& value) {
        std::memcpy(bytes + place * 128, static_cast<const void*>(&value), sizeof value);
    }
    template <class T>
    T get(std::size_t place) const {
        T value;
        std::memcpy(static_cast<void*>(&value), bytes + place * 128, sizeof value);
        return value;
    }
    ActionResult run(Instruction in) {
        ProgramContext context;
        return in.run(context, in, bytes, bytes + 128, bytes + 256);
    }
};

/// Nothing: the action failed.
template <class R, class A, class B>
std::optional<R> compute(const OperatorMatch& match, const A& a, const B& b) {
    if (!match) return std::nullopt;
    Data data;
    data.put(1, a);
    data.put(2, b);
    if (data.run(match.instruction) != ActionResult::done) return std::nullopt;
    return data.get<R>(0);
}
template <class R, class A, class B>
std::optional<R> binary(Operator op, const A& a, const B& b) {
    return compute<R>(find_binary(op, type_id<A>, type_id<B>), a, b);
}
template <class R, class A>
std::optional<R> convert(const A& a) {
    const Conversion made = find_conversion(type_id<A>, type_id<R>);
    if (!made) return std::nullopt;
    Data data;
    data.put(1, a);
    if (data.run(made.instruction) != ActionResult::done) return std::nullopt;
    return data.get<R>(0);
}

constexpr ScriptInt most = std::numeric_limits<ScriptInt>::max();
constexpr ScriptInt least = std::numeric_limits<ScriptInt>::min();

constexpr ScriptInt sum_while_compiling() {
    std::byte data[48]{};
    store_value(data + 16, ScriptInt{40});
    store_value(data + 32, ScriptInt{2});
    ProgramContext context;
    const Instruction in = find_binary(Operator::add, script_int, script_int).instruction;
    in.run(context, in, data, data + 16, data + 32);
    return load_value<ScriptInt>(data);
}
static_assert(sum_while_compiling() == 42, "the same instruction computes in a constant expression");

TEST(Whole_numbers, are_added_subtracted_multiplied_and_divided_towards_zero) {
    EXPECT_EQ((binary<ScriptInt>(Operator::add, ScriptInt{7}, ScriptInt{-9})), -2);
    EXPECT_EQ((binary<ScriptInt>(Operator::subtract, ScriptInt{7}, ScriptInt{9})), -2);
    EXPECT_EQ((binary<ScriptInt>(Operator::multiply, ScriptInt{7}, ScriptInt{-9})), -63);
    EXPECT_EQ((binary<ScriptInt>(Operator::divide, ScriptInt{-7}, ScriptInt{2})), -3);
    EXPECT_EQ((binary<ScriptInt>(Operator::remainder, ScriptInt{-7}, ScriptInt{2})), -1);
}

TEST(Whole_numbers, that_overflow_or_are_divided_by_zero_fail_the_action) {
    EXPECT_FALSE((binary<ScriptInt>(Operator::add, most, ScriptInt{1})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::subtract, least, ScriptInt{1})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::multiply, most, ScriptInt{2})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::divide, ScriptInt{1}, ScriptInt{0})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::remainder, ScriptInt{1}, ScriptInt{0})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::divide, least, ScriptInt{-1})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::remainder, least, ScriptInt{-1})));
}

TEST(A_mixed_expression, asks_for_its_whole_operand_as_a_real) {
    const OperatorMatch sum = find_binary(Operator::add, script_int, script_double);
    EXPECT_EQ(sum.a, script_double);
    EXPECT_EQ(sum.b, script_double);
    EXPECT_EQ(sum.result, script_double);
    EXPECT_FALSE(find_binary(Operator::add, script_bool, script_double));
    EXPECT_FALSE(find_binary(Operator::remainder, script_double, script_double));
}

TEST(Operators, of_a_registered_type_are_found_from_either_side) {
    const auto sum = binary<Pose>(Operator::add, Pose{1, 2}, Pose{3, 4});
    ASSERT_TRUE(sum);
    EXPECT_EQ(sum->x, 4);
    EXPECT_EQ(sum->turn, 6);
    const OperatorMatch scaled = find_binary(Operator::multiply, type_id<Pose>, script_int);
    EXPECT_EQ(scaled.b, script_double) << "an int is taken where the function takes a double";
    EXPECT_FALSE(find_binary(Operator::subtract, type_id<Pose>, type_id<Pose>));
    const TypeId one[] = {type_id<Pose>};
    EXPECT_EQ(find_function("inverse", one).result, type_id<Pose>);
    EXPECT_FALSE(find_function("invert", one));
}

TEST(Integers_of_every_width, widen_when_read_and_are_checked_when_written) {
    EXPECT_EQ((convert<ScriptInt>(std::int8_t{-5})), -5);
    EXPECT_EQ((convert<ScriptInt>(std::uint32_t{4'000'000'000})), 4'000'000'000);
    EXPECT_FALSE((convert<ScriptInt>(std::numeric_limits<std::uint64_t>::max())));
    EXPECT_EQ((convert<std::int8_t>(ScriptInt{127})), 127);
    EXPECT_FALSE((convert<std::int8_t>(ScriptInt{128})));
    EXPECT_FALSE((convert<std::uint16_t>(ScriptInt{-1})));
    EXPECT_EQ((convert<std::uint64_t>(most)), static_cast<std::uint64_t>(most));
    EXPECT_FALSE((convert<float>(1e300)));
    EXPECT_FALSE((convert<ScriptInt>(std::numeric_limits<double>::quiet_NaN())));
}

} // namespace operators_test

// Expressions of scripts (thesis 5.1.4): the instruction that computes an operator, a function or a
// conversion, and its result, also in constant expressions.
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
inline constexpr auto tappet::fields_of<operators_test::Pose> = tappet::fields(
    tappet::field<&operators_test::Pose::x>("x"), tappet::field<&operators_test::Pose::turn>("turn"));
template <>
inline constexpr auto tappet::names_of<operators_test::Colour> =
    std::array<std::string_view, 2>{"red", "green"};

namespace operators_test {

using namespace tappet;

/// Memory of a program: one value in each of three places.
struct Data {
    alignas(16) std::byte bytes[3 * 1024]{};
    template <class T>
    void put(std::size_t place, const T& value) {
        std::memcpy(bytes + place * 1024, static_cast<const void*>(&value), sizeof value);
    }
    template <class T>
    T get(std::size_t place) const {
        T value;
        std::memcpy(static_cast<void*>(&value), bytes + place * 1024, sizeof value);
        return value;
    }
    ActionResult run(Instruction in) {
        ProgramContext context;
        return in.run(context, in, bytes, bytes + 1024, bytes + 2048);
    }
};

/// Returns nullopt when the action failed.
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

TEST(Whole_numbers, fail_the_action_on_overflow_and_division_by_zero) {
    EXPECT_FALSE((binary<ScriptInt>(Operator::add, most, ScriptInt{1})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::subtract, least, ScriptInt{1})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::multiply, most, ScriptInt{2})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::divide, ScriptInt{1}, ScriptInt{0})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::remainder, ScriptInt{1}, ScriptInt{0})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::divide, least, ScriptInt{-1})));
    EXPECT_FALSE((binary<ScriptInt>(Operator::remainder, least, ScriptInt{-1})));
}

TEST(A_mixed_expression, converts_its_integer_operand_to_a_real) {
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

TEST(Integers_of_every_width, are_widened_when_read_and_checked_when_written) {
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

TEST(Reals, follow_IEEE_754) {
    EXPECT_EQ((binary<double>(Operator::divide, 1.0, 0.0)), std::numeric_limits<double>::infinity());
    EXPECT_EQ((binary<double>(Operator::subtract, 1.5, 0.25)), 1.25);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ((binary<bool>(Operator::equal, nan, nan)), false);
    EXPECT_EQ((binary<bool>(Operator::unequal, nan, nan)), true);
    EXPECT_EQ((binary<bool>(Operator::at_most, nan, nan)), false);
}

TEST(Times, support_arithmetic_with_times) {
    EXPECT_EQ((binary<Duration>(Operator::add, Duration{20ms}, Duration{5s})), Duration{5020ms});
    EXPECT_EQ((binary<Duration>(Operator::multiply, Duration{20ms}, ScriptInt{3})), Duration{60ms});
    EXPECT_EQ((binary<Duration>(Operator::multiply, 0.5, Duration{20ms})), Duration{10ms});
    EXPECT_EQ((binary<Duration>(Operator::divide, Duration{20ms}, 4.0)), Duration{5ms});
    EXPECT_EQ((binary<double>(Operator::divide, Duration{20ms}, Duration{8ms})), 2.5);
    EXPECT_EQ((binary<bool>(Operator::less, Duration{20ms}, Duration{8ms})), false);
    EXPECT_FALSE((binary<Duration>(Operator::add, Duration::max(), Duration{1ns})));
    EXPECT_FALSE((binary<Duration>(Operator::divide, Duration{1s}, 0.0))) << "no time is that long";
    EXPECT_FALSE(find_binary(Operator::add, script_duration, script_int)) << "20 ms + 3 means nothing";
    EXPECT_FALSE(find_binary(Operator::multiply, script_duration, script_duration));
}

template <class T>
void order_is_that_of_the_language(const T& low, const T& high) {
    const auto says = [](Operator op, const T& a, const T& b) { return binary<bool>(op, a, b); };
    for (const auto& [a, b] : {std::pair{low, high}, std::pair{high, low}, std::pair{low, low}}) {
        EXPECT_EQ(says(Operator::equal, a, b), a == b);
        EXPECT_EQ(says(Operator::unequal, a, b), a != b);
        EXPECT_EQ(says(Operator::less, a, b), a < b);
        EXPECT_EQ(says(Operator::at_most, a, b), a <= b);
        EXPECT_EQ(says(Operator::greater, a, b), a > b);
        EXPECT_EQ(says(Operator::at_least, a, b), a >= b);
    }
}
TEST(Numbers_and_times, are_compared) {
    order_is_that_of_the_language<ScriptInt>(least, most);
    order_is_that_of_the_language<double>(-1.5, 2);
    order_is_that_of_the_language<Duration>(Duration{-1ns}, Duration{1s});
}

TEST(Truths, support_and_or_and_not) {
    for (const bool a : {false, true}) {
        for (const bool b : {false, true}) {
            EXPECT_EQ((binary<bool>(Operator::both, a, b)), a && b);
            EXPECT_EQ((binary<bool>(Operator::either, a, b)), a || b);
            EXPECT_EQ((binary<bool>(Operator::equal, a, b)), a == b);
            EXPECT_EQ((binary<bool>(Operator::unequal, a, b)), a != b);
        }
        EXPECT_EQ(compute<bool>(find_unary(Operator::invert, script_bool), a, 0), !a);
    }
    EXPECT_FALSE(find_binary(Operator::both, script_int, script_bool)) << "an int is no boolean";
    EXPECT_FALSE(find_unary(Operator::invert, script_int));
    EXPECT_FALSE(find_unary(Operator::negate, script_bool));
}

TEST(A_negation, fails_when_it_overflows) {
    EXPECT_EQ(compute<ScriptInt>(find_unary(Operator::negate, script_int), ScriptInt{5}, 0), -5);
    EXPECT_FALSE(compute<ScriptInt>(find_unary(Operator::negate, script_int), least, 0));
    EXPECT_EQ(compute<double>(find_unary(Operator::negate, script_double), 0.5, 0), -0.5);
}

TEST(Enumerations, are_compared_with_their_own_kind_only) {
    EXPECT_EQ((binary<bool>(Operator::equal, Colour::red, Colour::green)), false);
    EXPECT_EQ((binary<bool>(Operator::unequal, Colour::red, Colour::green)), true);
    EXPECT_FALSE(find_binary(Operator::equal, type_id<Colour>, script_int));
    EXPECT_FALSE(find_binary(Operator::less, type_id<Colour>, type_id<Colour>));
    const Conversion number = find_conversion(type_id<Colour>, script_int);
    EXPECT_TRUE(number);
    EXPECT_FALSE(number.implicit) << "int(colour), not colour + 1";
    EXPECT_EQ((convert<ScriptInt>(Colour::green)), 1);
    EXPECT_FALSE(find_conversion(script_int, type_id<Colour>));
}

TEST(Texts, of_any_lengths_are_compared_and_copied_when_they_fit) {
    EXPECT_EQ((binary<bool>(Operator::equal, Text<5>{"tape"}, ScriptText{"tape"})), true);
    EXPECT_EQ((binary<bool>(Operator::unequal, Text<5>{"tape"}, ScriptText{"tap"})), true);
    EXPECT_EQ((convert<Text<5>>(ScriptText{"tape"})), Text<5>{"tape"});
    EXPECT_EQ((convert<ScriptText>(Text<3>{"abc"})), ScriptText{"abc"});
    EXPECT_FALSE((convert<Text<3>>(ScriptText{"tape"})));
    EXPECT_EQ((convert<Text<3>>(ScriptText{"tap"})), Text<3>{"tap"});
}

TEST(Functions, are_found_by_name_and_operands) {
    const TypeId one[] = {script_int};
    const TypeId two[] = {script_int, script_double};
    EXPECT_EQ(find_function("abs", one).result, script_int);
    EXPECT_EQ(find_function("sqrt", one).a, script_double) << "the whole operand is converted";
    EXPECT_EQ(find_function("max", two).result, script_double);
    EXPECT_FALSE(find_function("sqrt", two));
    EXPECT_FALSE(find_function("squirt", one));
    EXPECT_FALSE(find_function("abs", {}));
    EXPECT_EQ((compute<double>(find_function("atan2", two), 1.0, 1.0)), std::atan2(1.0, 1.0));
    EXPECT_FALSE((compute<ScriptInt>(find_function("abs", one), least, 0)));
    EXPECT_EQ((compute<ScriptInt>(find_function("abs", one), ScriptInt{-3}, 0)), 3);
    const TypeId time[] = {script_duration};
    EXPECT_EQ((compute<double>(find_function("seconds", time), Duration{250ms}, 0)), 0.25);
    const TypeId real[] = {script_double};
    EXPECT_EQ((compute<Duration>(find_function("duration", real), 0.25, 0)), Duration{250ms});
    EXPECT_EQ((compute<ScriptInt>(find_function("int", real), -2.75, 0)), -2);
    for (const auto& [name, expected] :
         {std::pair{"sin", std::sin(0.5)}, std::pair{"cos", std::cos(0.5)}, std::pair{"exp", std::exp(0.5)},
          std::pair{"log", std::log(0.5)}, std::pair{"floor", 0.0}, std::pair{"ceil", 1.0},
          std::pair{"round", 1.0}, std::pair{"abs", 0.5}, std::pair{"sqrt", std::sqrt(0.5)}})
        EXPECT_EQ((compute<double>(find_function(name, real), 0.5, 0)), expected) << name;
}

TEST(Every_name_of_a_function, is_found_by_some_operands) {
    const TypeId types[] = {script_int,
                            script_double,
                            script_duration,
                            script_bool,
                            type_id<Eigen::Vector3d>,
                            type_id<Bounded<int, 4>>};
    for (const std::string_view name : function_names()) {
        bool found = false;
        for (const TypeId a : types) {
            const TypeId both[] = {a, a};
            found = found || find_function(name, std::span{both}.first(1)) || find_function(name, both);
        }
        EXPECT_TRUE(found) << name;
    }
}

// ---- matrices, against Eigen

template <class M>
M filled(int seed) {
    M m;
    for (int i = 0; i < m.size(); ++i)
        m.data()[i] = static_cast<typename M::Scalar>((seed * 7 + i * 5) % 11 - 4);
    return m;
}
template <class M>
void elements_are_computed_as_by_eigen() {
    const M a = filled<M>(1), b = filled<M>(2);
    EXPECT_EQ(binary<M>(Operator::add, a, b), M(a + b));
    EXPECT_EQ(binary<M>(Operator::subtract, a, b), M(a - b));
    EXPECT_EQ(compute<M>(find_unary(Operator::negate, type_id<M>), a, 0), M(-a));
    EXPECT_EQ(binary<bool>(Operator::equal, a, a), true);
    EXPECT_EQ(binary<bool>(Operator::equal, a, b), a == b);
    EXPECT_EQ(binary<bool>(Operator::unequal, a, b), a != b);
    using Number = primitive::Scale<typename M::Scalar>;
    const auto three = static_cast<typename M::Scalar>(3);
    EXPECT_EQ((binary<M>(Operator::multiply, a, Number{3})), M(a * three));
    EXPECT_EQ((binary<M>(Operator::multiply, Number{3}, a)), M(a * three));
    EXPECT_EQ((binary<M>(Operator::divide, a, Number{2})), M(a / static_cast<typename M::Scalar>(2)));
}
TEST(Matrices, are_added_scaled_and_compared_element_by_element) {
    elements_are_computed_as_by_eigen<Eigen::Vector3d>();
    elements_are_computed_as_by_eigen<Eigen::Matrix<float, 2, 5>>();
    elements_are_computed_as_by_eigen<Eigen::Matrix<double, 3, 2, Eigen::RowMajor>>();
    elements_are_computed_as_by_eigen<Eigen::RowVector4d>();
    elements_are_computed_as_by_eigen<Eigen::Matrix<int, 3, 3>>();
}

template <class A, class B, class R>
void product_is_that_of_eigen() {
    const A a = filled<A>(3);
    const B b = filled<B>(4);
    const OperatorMatch match = find_binary(Operator::multiply, type_id<A>, type_id<B>);
    ASSERT_TRUE(match);
    EXPECT_EQ(match.result->rows, static_cast<std::size_t>(R::RowsAtCompileTime));
    EXPECT_EQ(match.result->columns, static_cast<std::size_t>(R::ColsAtCompileTime));
    ASSERT_FALSE(match.result->row_major);
    EXPECT_EQ((compute<R>(match, a, b)), R(a * b));
}
TEST(Products, of_fitting_matrices_equal_those_of_eigen) {
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    product_is_that_of_eigen<Eigen::Matrix3d, Eigen::Vector3d, Eigen::Vector3d>();
    product_is_that_of_eigen<Eigen::Matrix3d, Eigen::Matrix3d, Eigen::Matrix3d>();
    product_is_that_of_eigen<Eigen::Matrix<double, 3, 2>, Eigen::Matrix<double, 2, 4>,
                             Eigen::Matrix<double, 3, 4>>();
    product_is_that_of_eigen<Eigen::Vector3d, Eigen::RowVector3d, Eigen::Matrix3d>();
    product_is_that_of_eigen<RowMajor, Eigen::Vector3d, Eigen::Vector3d>();
    product_is_that_of_eigen<Eigen::Matrix3f, Eigen::Vector3f, Eigen::Vector3f>();
    EXPECT_EQ((binary<double>(Operator::multiply, Eigen::RowVector3d{1, 2, 3}, Eigen::Vector3d{4, 5, 6})),
              32);
    EXPECT_FALSE(find_binary(Operator::multiply, type_id<Eigen::Vector3d>, type_id<Eigen::Matrix3d>));
    EXPECT_FALSE(find_binary(Operator::multiply, type_id<Eigen::Matrix3d>, type_id<Eigen::Vector3f>));
    EXPECT_FALSE(find_binary(Operator::add, type_id<Eigen::Vector3d>, type_id<Eigen::Vector4d>));
}

TEST(Matrices_of_whole_numbers, fail_when_an_element_overflows) {
    const Eigen::Vector2i big{std::numeric_limits<int>::max(), 0};
    EXPECT_FALSE((binary<Eigen::Vector2i>(Operator::add, big, Eigen::Vector2i{1, 0})));
    EXPECT_FALSE((binary<Eigen::Vector2i>(Operator::multiply, big, ScriptInt{2})));
    EXPECT_FALSE((binary<Eigen::Vector2i>(Operator::divide, big, ScriptInt{0})));
}

TEST(Vectors, have_norm_dot_and_cross_product_and_a_transpose) {
    const Eigen::Vector3d a{1, -2, 2}, b{0.5, 4, -1};
    const TypeId one[] = {type_id<Eigen::Vector3d>};
    const TypeId two[] = {type_id<Eigen::Vector3d>, type_id<Eigen::Vector3d>};
    EXPECT_EQ((compute<double>(find_function("norm", one), a, 0)), 3);
    EXPECT_EQ((compute<double>(find_function("dot", two), a, b)), a.dot(b));
    const Eigen::Vector3d cross{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                a[0] * b[1] - a[1] * b[0]};
    EXPECT_EQ((compute<Eigen::Vector3d>(find_function("cross", two), a, b)), cross);
    const TypeId matrix[] = {type_id<Eigen::Matrix<double, 2, 3>>};
    const auto m = filled<Eigen::Matrix<double, 2, 3>>(5);
    const OperatorMatch turned = find_function("transpose", matrix);
    ASSERT_TRUE(turned);
    EXPECT_EQ((compute<Eigen::Matrix<double, 3, 2>>(turned, m, 0)),
              (Eigen::Matrix<double, 3, 2>(m.transpose())));
    EXPECT_FALSE(find_function("cross", matrix));
}

TEST(Matrices_of_one_shape, convert_to_each_other_in_any_storage_order) {
    using ByColumn = Eigen::Matrix<double, 2, 3>;
    using ByRow = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
    const auto m = filled<ByColumn>(6);
    EXPECT_EQ(convert<ByRow>(m), ByRow(m));
    EXPECT_EQ(convert<ByColumn>(ByRow(m)), m);
    EXPECT_TRUE(find_conversion(matrix_type(3, 1), type_id<Eigen::Vector3d>).implicit);
    EXPECT_FALSE(find_conversion(type_id<Eigen::Vector3d>, type_id<Eigen::Vector4d>));
    EXPECT_FALSE(find_conversion(type_id<Eigen::Vector3d>, type_id<Eigen::RowVector3d>));
}

TEST(Elements, are_read_and_written_when_the_index_is_in_range) {
    for (const ScriptInt index : {-1, 0, 2, 3}) {
        const bool good = index >= 0 && index < 3;
        Data data;
        data.put(1, Eigen::Vector3d{5, 6, 7});
        data.put(2, index);
        EXPECT_EQ(data.run(element_read(type_id<Eigen::Vector3d>)),
                  good ? ActionResult::done : ActionResult::failed);
        EXPECT_EQ(data.get<double>(0), good ? 5.0 + static_cast<double>(index) : 0.0);
        data.put(0, Eigen::Vector3d{0, 0, 0});
        EXPECT_EQ(data.run(element_write(type_id<Eigen::Vector3d>)),
                  good ? ActionResult::done : ActionResult::failed);
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(data.get<Eigen::Vector3d>(0)[i], i == index ? 5.0 : 0.0)
                << "the first of `a` went there";
    }
    using Long = std::array<std::int16_t, 300>;
    Data data;
    data.put(2, ScriptInt{300});
    EXPECT_EQ(data.run(element_read(type_id<Long>)), ActionResult::failed);
    EXPECT_EQ(element_read(type_id<Long>).count(), 300u);
    EXPECT_EQ(element_read(script_double).run, nullptr) << "a number has no elements";
}

TEST(Rows_and_columns, find_the_element_in_either_storage_order) {
    using ByRow = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
    for (const auto& [type, expected] :
         {std::pair{type_id<Eigen::Matrix<double, 2, 3>>, 5}, std::pair{type_id<ByRow>, 5}}) {
        Data data;
        data.put(1, ScriptInt{1});
        data.put(2, ScriptInt{2});
        EXPECT_EQ(data.run(matrix_index(type)), ActionResult::done);
        EXPECT_EQ(data.get<ScriptInt>(0), expected);
        data.put(2, ScriptInt{0});
        EXPECT_EQ(data.run(matrix_index(type)), ActionResult::done);
        EXPECT_EQ(data.get<ScriptInt>(0), type == type_id<ByRow> ? 3 : 1);
        data.put(2, ScriptInt{3});
        EXPECT_EQ(data.run(matrix_index(type)), ActionResult::failed);
        data.put(2, ScriptInt{-1});
        EXPECT_EQ(data.run(matrix_index(type)), ActionResult::failed);
    }
}

TEST(Fields_of_a_record, are_read_and_written_separately) {
    const std::span fields = type_id<Pose>->fields;
    ASSERT_EQ(fields.size(), 2u);
    Data data;
    data.put(1, Pose{1, 2});
    EXPECT_EQ(data.run(field_read(fields[1])), ActionResult::done);
    EXPECT_EQ(data.get<double>(0), 2);
    data.put(0, Pose{3, 4});
    EXPECT_EQ(data.run(field_write(fields[1])), ActionResult::done);
    EXPECT_EQ(data.get<Pose>(0).x, 3);
    EXPECT_EQ(data.get<Pose>(0).turn, 1) << "the first of `a` went there";
}

TEST(A_sequence, reports_its_number_of_elements) {
    using List = Bounded<int, 4>;
    List list;
    ASSERT_TRUE(list.push(7));
    ASSERT_TRUE(list.push(8));
    const TypeId one[] = {type_id<List>};
    EXPECT_EQ((compute<ScriptInt>(find_function("size", one), list, 0)), 2);
}

TEST(Elements_of_a_sequence, exist_only_up_to_its_length) {
    using List = Bounded<std::int16_t, 5>;
    List list;
    ASSERT_TRUE(list.push(7));
    ASSERT_TRUE(list.push(8));
    for (const ScriptInt index : {-1, 0, 1, 2, 4, 5}) {
        const bool good = index == 0 || index == 1;
        Data data;
        data.put(1, list);
        data.put(2, index);
        EXPECT_EQ(data.run(element_read(type_id<List>)), good ? ActionResult::done : ActionResult::failed);
        EXPECT_EQ(data.get<std::int16_t>(0), good ? 7 + index : 0);
        data.put(0, list);
        data.put(1, std::int16_t{9});
        EXPECT_EQ(data.run(element_write(type_id<List>)), good ? ActionResult::done : ActionResult::failed);
        EXPECT_EQ(data.get<List>(0).items[1], index == 1 ? 9 : 8);
    }
}

} // namespace operators_test

// Type tags: plain data describes the bytes of a value (thesis 4.7.2: a facet is found by name and type).
#include "kernel/base/only_numbers.hpp"
#include "kernel/base/type_tag.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <cstring>
#include <limits>

namespace {

using namespace tappet;

enum class Cause : std::uint8_t { none, weft, warp };
enum class Nameless : std::int16_t { one = 1 };

struct Pose {
    bool valid;
    double turn;
    Eigen::Vector2f place;
    Cause cause;
};
struct Plan {
    std::int32_t number;
    Pose from, to;
};
struct Secret {
    int bits;
};

} // namespace

template <>
inline constexpr auto tappet::names_of<Cause> = std::array<std::string_view, 3>{"none", "weft", "warp"};
template <>
inline constexpr auto tappet::fields_of<Pose> =
    fields(field<&Pose::valid>("valid"), field<&Pose::turn>("turn", "deg"),
           field<&Pose::place>("place", "mm"), field<&Pose::cause>("cause"));
template <>
inline constexpr auto tappet::fields_of<Plan> =
    fields(field<&Plan::number>("number"), field<&Plan::from>("from"), field<&Plan::to>("to"));

namespace {

static_assert(type_id<bool>->kind == ValueKind::boolean && type_id<std::int8_t>->kind == ValueKind::integer &&
              type_id<std::uint64_t>->kind == ValueKind::natural && type_id<float>->kind == ValueKind::real &&
              type_id<Duration>->kind == ValueKind::duration && type_id<Time>->kind == ValueKind::duration);
static_assert(type_id<long double>->kind == ValueKind::opaque && type_id<Secret>->kind == ValueKind::opaque &&
              type_id<int*>->kind == ValueKind::opaque);

TEST(TypeTag, distinguishes_two_types_of_one_shape) {
    EXPECT_NE(type_id<long>, type_id<long long>);
    EXPECT_EQ(type_id<double>, type_id<double>);
}

TEST(TypeTag, describes_the_shape_and_element_order_of_a_matrix) {
    const TypeTag& columns = *type_id<Eigen::Matrix<float, 2, 3>>;
    EXPECT_EQ(columns.kind, ValueKind::matrix);
    EXPECT_EQ(columns.element, type_id<float>);
    EXPECT_EQ(columns.rows, 2u);
    EXPECT_EQ(columns.columns, 3u);
    EXPECT_FALSE(columns.row_major);
    EXPECT_TRUE((type_id<Eigen::Matrix<float, 2, 3, Eigen::RowMajor>>->row_major));
    EXPECT_EQ((type_id<std::array<Cause, 4>>->rows), 4u);
    EXPECT_EQ((type_id<std::array<Cause, 4>>->element), type_id<Cause>);
    EXPECT_EQ(type_id<Eigen::VectorXd>->kind, ValueKind::opaque) << "it points to its numbers";
}

TEST(TypeTag, finds_the_fields_of_a_record_at_their_offsets) {
    const TypeTag& tag = *type_id<Plan>;
    ASSERT_EQ(tag.kind, ValueKind::record);
    ASSERT_EQ(tag.fields.size(), 3u);
    EXPECT_EQ(tag.fields[2].name, "to");
    EXPECT_EQ(tag.fields[2].type, type_id<Pose>);
    EXPECT_EQ(tag.fields[2].offset(), offsetof(Plan, to));
    const auto& pose = type_id<Pose>->fields;
    EXPECT_EQ(pose[1].unit, "deg");
    EXPECT_EQ(pose[0].offset(), 0u);
    EXPECT_EQ(pose[1].offset(), offsetof(Pose, turn));
    EXPECT_EQ(pose[2].offset(), offsetof(Pose, place));
    EXPECT_EQ(pose[3].offset(), offsetof(Pose, cause));
}

TEST(TypeTag, knows_the_names_and_the_underlying_integer_of_an_enumeration) {
    EXPECT_EQ(type_id<Cause>->kind, ValueKind::enumeration);
    EXPECT_EQ(type_id<Cause>->names[2], "warp");
    EXPECT_EQ(type_id<Cause>->element, type_id<std::uint8_t>);
    EXPECT_EQ(type_id<Nameless>->kind, ValueKind::integer) << "without names a number";
}

template <class T>
std::size_t length_of(const T& value) {
    const TypeTag& tag = *type_id<T>;
    std::uint64_t length = 0;
    std::memcpy(&length, reinterpret_cast<const std::byte*>(&value) + tag.length_at, tag.length_bytes);
    return length;
}

TEST(TypeTag, finds_the_length_of_a_text_and_of_a_sequence) {
    EXPECT_EQ(length_of(Text<13>{"weft"}), 4u);
    EXPECT_EQ(length_of(Text<16>{""}), 0u);
    Bounded<std::uint8_t, 5> few;
    ASSERT_TRUE(few.push(9));
    EXPECT_EQ(length_of(few), 1u);
    Bounded<double, 3> full;
    for (double each : {1.0, 2.0, 3.0}) ASSERT_TRUE(full.push(each));
    EXPECT_EQ(length_of(full), 3u);
    EXPECT_EQ((type_id<Bounded<double, 3>>->columns), 3u);
}

TEST(Text, refuses_text_longer_than_its_capacity_and_keeps_its_content) {
    Text<4> text{"warp"};
    EXPECT_FALSE(text.assign("shaft"));
    EXPECT_EQ(text.view(), "warp");
    EXPECT_TRUE(text.assign("io"));
    EXPECT_EQ(text, Text<4>{"io"}) << "no character of the longer text stays behind";
    EXPECT_TRUE(text.assign(""));
    EXPECT_EQ(text, Text<4>{});
}

template <class T>
bool is_good(const T& value) {
    return has_only_numbers(*type_id<T>, reinterpret_cast<const std::byte*>(&value));
}

TEST(OnlyNumbers, are_required_in_all_used_parts_of_a_value) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
        EXPECT_FALSE(is_good(bad));
        EXPECT_FALSE(is_good(static_cast<float>(bad)));
        EXPECT_FALSE(is_good(Eigen::Vector3d{0.0, 1.0, bad}));
        Plan plan{.number = 7, .from = {}, .to = {}};
        plan.from.place = plan.to.place = {1.0F, 2.0F};
        EXPECT_TRUE(is_good(plan));
        plan.to.place[1] = static_cast<float>(bad);
        EXPECT_FALSE(is_good(plan));
        Bounded<double, 4> few;
        EXPECT_TRUE(few.push(1.0) && few.push(2.0) && few.push(bad));
        EXPECT_FALSE(is_good(few));
        few.used = 2;
        EXPECT_TRUE(is_good(few)) << "there are two";
    }
    EXPECT_TRUE(is_good(1e308));
    EXPECT_TRUE(is_good(std::int64_t{-1}));
    EXPECT_TRUE(is_good(Eigen::Vector3d{0.0, 1.0, 2.0}));
}

} // namespace

// Units of measurement: which are equal in any spelling, and which are not.
#include "kernel/machine/check/units.hpp"

#include <gtest/gtest.h>

namespace tappet::checks {
namespace {

enum class Are { same, of_another_size, of_another_kind, unknown };

constexpr Are compare(std::string_view a, std::string_view b) {
    const Unit one = parse_unit(a), other = parse_unit(b);
    if (!one.known || !other.known) return Are::unknown;
    return one.same(other) ? Are::same : one.same_kind(other) ? Are::of_another_size : Are::of_another_kind;
}

TEST(Units, are_equal_when_they_mean_the_same_in_any_spelling) {
    EXPECT_EQ(compare("N m", "m.N"), Are::same);
    EXPECT_EQ(compare("rpm", "rev/min"), Are::same);
    EXPECT_EQ(compare("mm/s2", "mm/s/s"), Are::same);
    EXPECT_EQ(compare("kPa", "N/m2/1"), Are::of_another_size);
    EXPECT_EQ(compare("Pa", "N/m2"), Are::same);
    EXPECT_EQ(compare("Hz", "1/s"), Are::same);
    EXPECT_EQ(compare("W", "J/s"), Are::same);
    EXPECT_EQ(compare("V.A", "W"), Are::same);
}

TEST(Units, distinguish_another_scale_from_another_quantity) {
    EXPECT_EQ(compare("l/min", "ml/s"), Are::of_another_size);
    EXPECT_EQ(compare("deg", "rad"), Are::of_another_size);
    EXPECT_EQ(compare("ms", "s"), Are::of_another_size);
    EXPECT_EQ(compare("bar", "kPa"), Are::of_another_size);
    EXPECT_EQ(compare("rpm", "deg/s"), Are::of_another_size);
    EXPECT_EQ(compare("rpm", "mm/s"), Are::of_another_kind);
    EXPECT_EQ(compare("degC", "K"), Are::of_another_kind) << "no factor leads from one to the other";
    EXPECT_EQ(compare("min", "m"), Are::of_another_kind) << "a minute is no metre with a prefix";
}

TEST(Units, are_plain_words_when_they_cannot_be_parsed) {
    for (const std::string_view word : {"picks", "m/", "/s", "m//s", "m (s)", "xm", "m0", "2"})
        EXPECT_FALSE(parse_unit(word).known) << word;
}

TEST(Units, are_converted_by_a_factor_within_one_quantity_only) {
    const auto factor = [](std::string_view from, std::string_view to) {
        const Facet source{.unit = from}, target{.unit = to};
        return factor_of(data("a", "b", converted), source, target);
    };
    EXPECT_TRUE(converts(parse_unit("l/min"), parse_unit("ml/s")));
    EXPECT_DOUBLE_EQ(factor("l/min", "ml/s"), 1000.0 / 60.0);
    EXPECT_DOUBLE_EQ(factor("rpm", "deg/s"), 6.0);
    EXPECT_DOUBLE_EQ(factor("bar", "kPa"), 100.0);
    EXPECT_FALSE(converts(parse_unit("degC"), parse_unit("K"))) << "no factor leads there";
    EXPECT_FALSE(converts(parse_unit("1"), parse_unit("mm"))) << "1 is the unit of what has none";
    EXPECT_FALSE(converts(parse_unit("picks"), parse_unit("picks"))) << "a word is no unit";
    EXPECT_EQ(factor_of(data("a", "b", scaled(0.5)), Facet{}, Facet{}), 0.5);
    EXPECT_EQ(factor_of(data("a", "b"), Facet{}, Facet{}), 1.0);
}

} // namespace
} // namespace tappet::checks

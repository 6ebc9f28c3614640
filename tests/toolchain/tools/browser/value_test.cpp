// How values of every shape are shown (thesis 4.7.2: what a name stands for is known with its type and unit).
#include "toolchain/tools/browser/value.hpp"

#include "tests/toolchain/tools/browser/sample_machine.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

namespace tappet::browser {
namespace {

template <class T> std::vector<std::byte> bytes_of(const T& value) {
    const auto bytes = std::as_bytes(std::span{&value, 1});
    return {bytes.begin(), bytes.end()};
}

class Values : public testing::Test {
protected:
    std::string shown(std::uint32_t type, const std::vector<std::byte>& bytes, Style style = Style::exact) {
        const std::vector<std::byte> block = sample.build();
        const auto map = MapReader::open(block);
        EXPECT_TRUE(map.has_value()) << map.error();
        return to_text(*map, type, bytes, style);
    }
    SampleMap sample;
};

TEST_F(Values, numbers_are_shown_as_they_can_be_read_back) {
    EXPECT_EQ(shown(sample.f64, bytes_of(0.1)), "0.1");
    EXPECT_EQ(shown(sample.f64, bytes_of(1.0 / 3.0)), "0.3333333333333333");
    EXPECT_EQ(shown(sample.f64, bytes_of(1.0 / 3.0), Style::brief), "0.333333");
    EXPECT_EQ(shown(sample.i32, bytes_of(std::int32_t{-7})), "-7");
    EXPECT_EQ(shown(sample.u8, bytes_of(std::uint8_t{200})), "200");
    EXPECT_EQ(shown(sample.boolean, bytes_of(true)), "true");
}

TEST_F(Values, nan_and_infinity_are_strings_in_json) {
    EXPECT_EQ(shown(sample.f64, bytes_of(std::numeric_limits<double>::quiet_NaN()), Style::json), "\"nan\"");
    EXPECT_EQ(shown(sample.f64, bytes_of(std::numeric_limits<double>::infinity()), Style::json), "\"inf\"");
}

TEST_F(Values, durations_have_the_largest_unit_that_leaves_a_whole_number) {
    EXPECT_EQ(shown(sample.duration, bytes_of(std::int64_t{4'000'000})), "4ms");
    EXPECT_EQ(shown(sample.duration, bytes_of(std::int64_t{1'500'000'000})), "1500ms");
    EXPECT_EQ(shown(sample.duration, bytes_of(std::int64_t{-2'000'000'000})), "-2s");
    EXPECT_EQ(shown(sample.duration, bytes_of(std::int64_t{7})), "7ns");
    EXPECT_EQ(shown(sample.duration, bytes_of(std::int64_t{0})), "0s");
    EXPECT_EQ(shown(sample.duration, bytes_of(std::int64_t{4'000'000}), Style::json), "\"4ms\"");
}

TEST_F(Values, times_are_rounded_for_people_and_still_read_as_they_are_shown) {
    const auto brief = [&](std::int64_t ns) { return shown(sample.duration, bytes_of(ns), Style::brief); };
    EXPECT_EQ(brief(0), "0s");
    EXPECT_EQ(brief(7), "7ns");
    EXPECT_EQ(brief(86'897), "86.897us");
    EXPECT_EQ(brief(500'000'000), "500ms");
    EXPECT_EQ(brief(1'234'567'891), "1.23457s");
    EXPECT_EQ(brief(-2'500'000), "-2.5ms");
    EXPECT_EQ(brief(123'456'789'000'000), "123457s");
    EXPECT_EQ(moment_text(86'897), "86.9us");
    EXPECT_EQ(moment_text(1'234'567'890'123), "1235s");
    EXPECT_EQ(clock_text(78'537'605'353'999), "78537.605354s");
}

TEST_F(Values, types_have_readable_names) {
    EXPECT_EQ(user_name("tappet::can::Bus<cut_to_length::can_signals>"), "can::Bus<can_signals>");
    EXPECT_EQ(user_name("cut_to_length::Line"), "Line");
    EXPECT_EQ(user_name("tappet::Map<of_a::deep::Name, 3>"), "Map<Name, 3>");
    EXPECT_EQ(user_name("Plain"), "Plain");
    EXPECT_EQ(user_name(""), "");
    const auto matrix = sample.matrix(sample.f64, 3, 1, false);
    const auto name = sample.text_type(16);
    const auto list = sample.sequence(sample.u8, 3);
    const auto when = sample.type("std::chrono::time_point<tappet::MachineClock>", map::Shape::duration, 8);
    const auto record = sample.type("plant::Wrench", map::Shape::opaque, 8);
    const std::vector<std::byte> block = sample.build();
    const auto map = MapReader::open(block);
    ASSERT_TRUE(map) << map.error();
    EXPECT_EQ(type_name(*map, sample.i32), "int32");
    EXPECT_EQ(type_name(*map, sample.u8), "uint8");
    EXPECT_EQ(type_name(*map, sample.duration), "Duration");
    EXPECT_EQ(type_name(*map, when), "Time");
    EXPECT_EQ(type_name(*map, matrix), "double[3]");
    EXPECT_EQ(type_name(*map, name), "Text<16>");
    EXPECT_EQ(type_name(*map, list), "Sequence<uint8, 3>");
    EXPECT_EQ(type_name(*map, record), "Wrench");
    EXPECT_EQ(signature(*map, when), "(Time)");
}

TEST_F(Values, an_enumeration_is_shown_by_name_and_an_unknown_value_by_number) {
    const auto type = sample.enumeration("State", 1, {{"stopped", 0}, {"weaving", 200}});
    EXPECT_EQ(shown(type, bytes_of(std::uint8_t{200})), "weaving");
    EXPECT_EQ(shown(type, bytes_of(std::uint8_t{200}), Style::json), "\"weaving\"");
    EXPECT_EQ(shown(type, bytes_of(std::uint8_t{9})), "9");
}

TEST_F(Values, matrices_are_shown_by_rows_whatever_their_order_in_memory) {
    const std::array<double, 6> numbers{1, 2, 3, 4, 5, 6};
    EXPECT_EQ(shown(sample.matrix(sample.f64, 2, 3, false), bytes_of(numbers)), "[[1, 3, 5], [2, 4, 6]]");
    EXPECT_EQ(shown(sample.matrix(sample.f64, 2, 3, true), bytes_of(numbers)), "[[1, 2, 3], [4, 5, 6]]");
    EXPECT_EQ(shown(sample.matrix(sample.f64, 6, 1, false), bytes_of(numbers)), "[1, 2, 3, 4, 5, 6]");
}

TEST_F(Values, records_have_names_and_texts_have_quotes) {
    const auto point = sample.record("Point", {{"x", sample.f64}, {"y", sample.f64}});
    EXPECT_EQ(shown(point, bytes_of(std::array<double, 2>{1, 2.5})), "{x: 1, y: 2.5}");
    EXPECT_EQ(shown(point, bytes_of(std::array<double, 2>{1, 2.5}), Style::json), R"({"x": 1, "y": 2.5})");
    std::array<char, 20> text{4, 0, 0, 0, 'a', '"', 'b', '\n'};
    EXPECT_EQ(shown(sample.text_type(16), bytes_of(text)), "\"a\\\"b\\u000a\"");
}

TEST_F(Values, an_impossible_length_is_cut_at_the_capacity) {
    const auto type = sample.sequence(sample.u8, 3);
    std::array<std::uint8_t, 11> bytes{255, 255, 255, 255, 255, 255, 255, 255, 1, 2, 3};
    EXPECT_EQ(shown(type, bytes_of(bytes)), "[1, 2, 3]");
}

TEST_F(Values, arguments_are_a_list_and_have_a_signature) {
    const auto list =
        sample.record("arguments", {{"", sample.f64}, {"", sample.boolean}}, map::Shape::arguments);
    std::vector<std::byte> bytes = bytes_of(2.5);
    bytes.push_back(std::byte{1});
    EXPECT_EQ(shown(list, bytes), "(2.5, true)");
    const std::vector<std::byte> block = sample.build();
    EXPECT_EQ(signature(*MapReader::open(block), list), "(double, bool)");
}

TEST(Words, are_quoted_to_stay_one_word) {
    EXPECT_EQ(as_word("12.5"), "12.5");
    EXPECT_EQ(as_word("[1, 2]"), "[1, 2]");
    EXPECT_EQ(as_word("two words"), "\"two words\"");
    EXPECT_EQ(as_word("a\"b"), "\"a\\\"b\"");
    EXPECT_EQ(as_word(""), "\"\"");
}

} // namespace
} // namespace tappet::browser

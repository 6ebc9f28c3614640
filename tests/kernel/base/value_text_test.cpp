// Values as text and back: exactly the same value, or a message with the fault (thesis 4.7.1, 4.8: a browser
// shows and sets them).
#include "kernel/base/random.hpp"
#include "kernel/base/value_text.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace {

using namespace tappet;

enum class Cause : std::uint8_t { none, weft, warp };
struct Pose {
    bool valid = false;
    double turn = 0;
    Eigen::Vector2d place{0, 0};
    Text<8> name{};
};

} // namespace

template <>
inline constexpr auto tappet::names_of<Cause> = std::array<std::string_view, 3>{"none", "weft", "warp"};
template <>
inline constexpr auto tappet::fields_of<Pose> =
    fields(field<&Pose::valid>("valid"), field<&Pose::turn>("turn", "deg"),
           field<&Pose::place>("place", "mm"), field<&Pose::name>("name"));

namespace {

template <class T>
const std::byte* bytes_of(const T& value) {
    return reinterpret_cast<const std::byte*>(&value);
}
template <class T>
std::string text_of(const T& value) {
    char room[400];
    return {room, format_value(*type_id<T>, bytes_of(value), room)};
}
template <class T>
std::string json_of(const T& value) {
    char room[400];
    return {room, format_json(*type_id<T>, bytes_of(value), room)};
}
/// The fault of a text; "" when there is none.
template <class T>
std::string fault_in(std::string_view text, T& into) {
    return std::string{parse_value(*type_id<T>, text, reinterpret_cast<std::byte*>(&into)).view()};
}
template <class T>
std::string fault_in(std::string_view text) {
    T into{};
    return fault_in(text, into);
}
template <class T>
T parsed(std::string_view text) {
    T into{};
    EXPECT_EQ(fault_in(text, into), "") << text;
    return into;
}
template <class T>
bool same_bytes(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}
template <class T>
void expect_round_trip(const T& value) {
    EXPECT_TRUE(same_bytes(parsed<T>(text_of(value)), value)) << text_of(value);
    EXPECT_TRUE(same_bytes(parsed<T>(json_of(value)), value)) << json_of(value);
}

TEST(ValueText, spells_each_kind_of_value_as_an_engineer_writes_it) {
    EXPECT_EQ(text_of(true), "true");
    EXPECT_EQ(text_of(std::int8_t{-12}), "-12");
    EXPECT_EQ(text_of(std::numeric_limits<std::uint64_t>::max()), "18446744073709551615");
    EXPECT_EQ(text_of(0.1), "0.1");
    EXPECT_EQ(text_of(0.1f), "0.1");
    EXPECT_EQ(text_of(-std::numeric_limits<double>::infinity()), "-inf");
    EXPECT_EQ(text_of(Duration{4ms}), "4ms");
    EXPECT_EQ(text_of(Duration{1500ms}), "1500ms");
    EXPECT_EQ(text_of(Duration{0}), "0s");
    EXPECT_EQ(text_of(at_ns(1'000'000'001)), "1000000001ns");
    EXPECT_EQ(text_of(Cause::weft), "weft");
    EXPECT_EQ(text_of(static_cast<Cause>(7)), "7") << "a value without a name";
    EXPECT_EQ(text_of(Text<20>{"a \"b\"\n\x01"}), R"("a \"b\"\n\x01")");
    EXPECT_EQ(text_of(Eigen::Vector3d{1, 2.5, -3}), "[1, 2.5, -3]");
    EXPECT_EQ(text_of(std::array<Cause, 2>{Cause::warp, Cause::none}), "[warp, none]");
    EXPECT_EQ(text_of(Bounded<int, 4>{}), "[]");
    EXPECT_EQ(text_of(Pose{true, 0.5, {1, 2}, "roll"}),
              R"({valid: true, turn: 0.5, place: [1, 2], name: "roll"})");
}

TEST(ValueText, writes_a_matrix_row_by_row_in_any_storage_order) {
    Eigen::Matrix<int, 2, 3> columns;
    columns << 1, 2, 3, 4, 5, 6;
    const Eigen::Matrix<int, 2, 3, Eigen::RowMajor> rows = columns;
    EXPECT_EQ(text_of(columns), "[[1, 2, 3], [4, 5, 6]]");
    EXPECT_EQ(text_of(rows), "[[1, 2, 3], [4, 5, 6]]");
    EXPECT_EQ((parsed<Eigen::Matrix<int, 2, 3>>("[[1,2,3],[4,5,6]]")), columns);
    EXPECT_EQ((parsed<Eigen::Matrix<int, 2, 3, Eigen::RowMajor>>("[[1 2 3] [4 5 6]]")), rows);
}

TEST(ValueText, writes_standard_json) {
    EXPECT_EQ(json_of(Duration{4ms}), "\"4ms\"");
    EXPECT_EQ(json_of(Cause::weft), "\"weft\"");
    EXPECT_EQ(json_of(std::nan("")), "\"nan\"");
    EXPECT_EQ(json_of(Text<20>{"\x01\x7f\"\\"}), R"("\u0001\u007f\"\\")");
    EXPECT_EQ(json_of(Text<20>{"\xc3\xa4"}), "\"\xc3\xa4\"") << "valid UTF-8 as it is";
    EXPECT_EQ(json_of(Text<20>{"\xff\xe4x"}), "\"\xEF\xBF\xBD\xEF\xBF\xBDx\"") << "and what is not, replaced";
    EXPECT_EQ(json_of(Pose{true, 0.5, {1, 2}, "roll"}),
              R"({"valid": true, "turn": 0.5, "place": [1, 2], "name": "roll"})");
}

TEST(ValueText, shows_an_opaque_value_by_its_size_and_never_parses_one) {
    struct Secret {
        int bits[4];
    };
    EXPECT_EQ(text_of(Secret{}), "<16 bytes>");
    EXPECT_EQ(json_of(Secret{}), "\"<16 bytes>\"");
    EXPECT_NE(fault_in<Secret>("<16 bytes>").find("has no spelling; name its fields with fields_of"),
              std::string::npos);
}

TEST(ValueText, writes_a_value_in_full_or_not_at_all) {
    const Eigen::Vector3d value{1, 2.5, -3};
    const std::string whole = text_of(value);
    for (std::size_t room = 0; room <= whole.size(); ++room) {
        std::string into(room, '?');
        const std::size_t written = format_value(*type_id<Eigen::Vector3d>, bytes_of(value), into);
        EXPECT_EQ(written, room < whole.size() ? 0 : whole.size()) << room;
    }
}

TEST(ValueText, stays_inside_the_value_when_its_bytes_are_invalid) {
    Text<4> torn;
    torn.length = 4000;
    EXPECT_EQ(text_of(torn), R"("\x00\x00\x00\x00")");
    Bounded<std::uint8_t, 3> list;
    list.used = 1u << 20;
    EXPECT_EQ(text_of(list), "[0, 0, 0]");
}

/// Any bit pattern of a number; special ones are more frequent than by chance.
class AnyValue : public testing::Test {
protected:
    Random random{static_cast<std::uint64_t>(testing::UnitTest::GetInstance()->random_seed())};

    template <class T>
    T any() {
        const std::uint64_t bits = random.next() >> (random.next() % 64);
        T value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }
};

TEST_F(AnyValue, restores_the_same_bits_of_a_number_or_time) {
    for (int i = 0; i < 20'000; ++i) {
        expect_round_trip(any<std::int8_t>());
        expect_round_trip(any<std::uint16_t>());
        expect_round_trip(any<std::int64_t>());
        expect_round_trip(any<std::uint64_t>());
        expect_round_trip(Duration{any<std::int64_t>()});
        expect_round_trip(static_cast<Cause>(any<std::uint8_t>()));
        if (const auto real = any<double>(); std::isfinite(real)) expect_round_trip(real);
        if (const auto real = any<float>(); std::isfinite(real)) expect_round_trip(real);
    }
    for (const std::int64_t edge :
         {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()})
        expect_round_trip(edge), expect_round_trip(Duration{edge}), expect_round_trip(at_ns(edge));
    expect_round_trip(-0.0);
    expect_round_trip(std::numeric_limits<double>::denorm_min());
    for (const double none : {std::nan(""), -HUGE_VAL, HUGE_VAL})
        EXPECT_NE(fault_in<double>(text_of(none)), "") << "it is told, and taken from nobody";
}

TEST_F(AnyValue, restores_every_character_of_a_text) {
    for (int i = 0; i < 5'000; ++i) {
        Text<12> text;
        std::string characters;
        for (std::uint64_t n = random.next() % 13; n > 0; --n) characters += static_cast<char>(random.next());
        ASSERT_TRUE(text.assign(characters));
        EXPECT_EQ(parsed<Text<12>>(text_of(text)), text) << text_of(text);
    }
}

TEST_F(AnyValue, restores_lists_and_records_with_all_elements) {
    for (int i = 0; i < 2'000; ++i) {
        expect_round_trip(Eigen::Matrix<float, 3, 2>{Eigen::Matrix<float, 3, 2>::NullaryExpr(
            [&] { return static_cast<float>(any<std::int32_t>()); })});
        Bounded<Duration, 5> list;
        for (std::uint64_t n = random.next() % 6; n > 0; --n)
            ASSERT_TRUE(list.push(Duration{any<std::int64_t>()}));
        expect_round_trip(list);
        Pose pose;
        pose.valid = (random.next() & 1) != 0;
        pose.turn = static_cast<double>(any<std::int64_t>()) / 3;
        pose.place = {1.0 / static_cast<double>(1 + random.next() % 99), -0.0};
        pose.name = "a\"}";
        const Pose back = parsed<Pose>(text_of(pose));
        EXPECT_EQ(text_of(back), text_of(pose));
        EXPECT_EQ(back.turn, pose.turn);
        EXPECT_EQ(back.place, pose.place);
        EXPECT_EQ(back.name, pose.name);
    }
}

TEST_F(AnyValue, survives_parsing_any_text) {
    constexpr std::string_view characters = "[]{}(),:\"\\ux0189.-+eEinfams valdtruplcenowgz\t";
    for (int i = 0; i < 40'000; ++i) {
        std::string text;
        for (std::uint64_t n = random.next() % 24; n > 0; --n)
            text += characters[random.next() % characters.size()];
        struct {
            Pose value{true, 7, {8, 9}, "before"};
        } const before;
        Pose pose = before.value;
        if (!fault_in(text, pose).empty()) {
            EXPECT_EQ(text_of(pose), text_of(before.value)) << "a refused text changes nothing: " << text;
        }
        static_cast<void>(fault_in<Eigen::Matrix2d>(text));
        static_cast<void>((fault_in<Bounded<Text<4>, 3>>(text)));
        static_cast<void>(fault_in<Cause>(text));
        static_cast<void>(fault_in<Duration>(text));
    }
}

TEST(ParseValue, accepts_times_in_several_units_that_are_whole_nanoseconds) {
    EXPECT_EQ(parsed<Duration>("1.5s"), 1500ms);
    EXPECT_EQ(parsed<Duration>("-0.25us"), -250ns);
    EXPECT_EQ(parsed<Duration>(" 2h "), 2h);
    EXPECT_EQ(parsed<Duration>("0.000000000025h"), 90ns);
    EXPECT_EQ(fault_in<Duration>("1.5ns"), "\"1.5ns\" is finer than 1ns; write whole nanoseconds");
    EXPECT_EQ(fault_in<Duration>("4"), "\"4\" has no unit; write ns, us, ms, s, min or h after it");
    EXPECT_EQ(fault_in<Duration>("9223372037s"),
              "\"9223372037s\" is too long; the longest time is 9223372036s");
    for (const char* none : {"", "ms", "-", ".5s", "1.s", "4 ms", "4msx", "--4ms"})
        EXPECT_NE(fault_in<Duration>(none), "") << none;
}

TEST(ParseValue, refuses_text_of_another_type_and_states_the_expected_one) {
    EXPECT_EQ(fault_in<std::int8_t>("128"), "128 is out of range; write a number from -128 to 127");
    EXPECT_EQ(fault_in<std::uint8_t>("-1"), "-1 is out of range; write a number from 0 to 255");
    EXPECT_EQ(fault_in<std::uint64_t>("18446744073709551616"),
              "18446744073709551616 is out of range; write a number from 0 to 18446744073709551615");
    EXPECT_EQ(fault_in<int>("12x"), "\"12x\" is not a whole number; write one such as -12");
    EXPECT_EQ(fault_in<int>("1 2"), "\"2\" is left over after the value; remove it");
    EXPECT_EQ(fault_in<double>("1e400"), "1e400 is out of range; a number of 8 bytes is too small for it");
    EXPECT_EQ(fault_in<double>("one"), "\"one\" is not a number; write one such as 0.5 or 2e-3");
    EXPECT_EQ(fault_in<bool>("yes"), "\"yes\" is neither true nor false; write one of them");
    EXPECT_EQ(fault_in<Text<4>>("shaft"), "the text has 5 characters, but there is room for 4; shorten it");
}

TEST(ParseValue, suggests_the_nearest_name) {
    EXPECT_NE(fault_in<Cause>("wefd").find("did you mean \"weft\"?"), std::string::npos);
    EXPECT_NE(fault_in<Cause>("lubrication").find("write one of none, weft, warp"), std::string::npos);
    EXPECT_NE(fault_in<Pose>("{trun: 1}").find("has no field \"trun\"; did you mean \"turn\"?"),
              std::string::npos);
}

TEST(ParseValue, locates_the_fault_in_a_composed_value) {
    EXPECT_EQ(fault_in<Eigen::Vector3d>("[1, x, 3]"),
              "element 2: \"x\" is not a number; write one such as 0.5 or 2e-3");
    EXPECT_EQ(fault_in<Eigen::Vector3d>("[1, 2]"), "has 2 elements instead of 3; write all of them");
    EXPECT_EQ(fault_in<Eigen::Vector3d>("[1, 2, 3, 4]"), "has more than 3 elements; remove what is too much");
    EXPECT_EQ(fault_in<Eigen::Vector3d>("1, 2, 3"),
              "\"1\" is not a list; write one in brackets, such as [1, 2]");
    EXPECT_EQ(fault_in<Eigen::Vector3d>("[1, 2, 3,]"),
              "the list breaks off; write another element, or \"]\" without a comma before it");
    EXPECT_EQ(fault_in<Eigen::Matrix2d>("[[1, 2], [3, q]]"),
              "row 2: element 2: \"q\" is not a number; write one such as 0.5 or 2e-3");
    EXPECT_EQ(fault_in<Pose>("{valid: true, turn: 1, place: [1, 2], name: \"far too long\"}"),
              "field \"name\": the text has 12 characters, but there is room for 8; shorten it");
    EXPECT_NE(fault_in<Pose>("{valid: true, turn: 1}").find("field \"place\" is missing"), std::string::npos);
    EXPECT_NE(fault_in<Pose>("{valid: true, valid: true}").find("is given twice; remove one"),
              std::string::npos);
}

TEST(ParseValue, accepts_record_fields_in_any_order_and_with_quoted_names) {
    const Pose pose = parsed<Pose>(R"({"place": [3, 4], name: roll, valid: true, "turn": -1})");
    EXPECT_EQ(text_of(pose), R"({valid: true, turn: -1, place: [3, 4], name: "roll"})");
}

TEST(ParseValue, accepts_a_lone_text_without_quotes) {
    EXPECT_EQ(parsed<Text<20>>("  the weft, broken "), Text<20>{"the weft, broken"});
    EXPECT_EQ(parsed<Text<20>>("\" weft\""), Text<20>{" weft"});
    EXPECT_EQ(parsed<Text<20>>(""), Text<20>{});
    EXPECT_EQ(parsed<Text<20>>(R"("\u00e4\ud83d\ude00")"), Text<20>{"\xc3\xa4\xf0\x9f\x98\x80"});
    for (const char* broken : {"\"weft", R"("\q")", R"("\ud83d")", R"("\xg0")", "\"a\"b"})
        EXPECT_NE(fault_in<Text<20>>(broken), "") << broken;
}

TEST(ParseValue, accepts_call_arguments_with_or_without_parentheses) {
    using Packed = std::array<std::byte, sizeof(double) + sizeof(Duration) + sizeof(Cause)>;
    const TypeTag& tag = *type_id<Arguments<double, Duration, Cause>>;
    ASSERT_EQ(tag.size, sizeof(Packed));
    for (const char* text : {"(1.5, 4ms, weft)", "1.5 4ms weft", "1.5, 4ms, weft"}) {
        Packed into{};
        EXPECT_EQ(parse_value(tag, text, into.data()).view(), "") << text;
        char room[60];
        EXPECT_EQ(std::string_view(room, format_value(tag, into.data(), room)), "(1.5, 4ms, weft)");
        EXPECT_EQ(std::string_view(room, format_json(tag, into.data(), room)), "[1.5, \"4ms\", \"weft\"]");
    }
    Packed into{};
    const auto fault = [&](std::string_view text) {
        return std::string{parse_value(tag, text, into.data()).view()};
    };
    EXPECT_EQ(fault("1.5 4 weft"), "argument 2: \"4\" has no unit; write ns, us, ms, s, min or h after it");
    EXPECT_EQ(fault("1.5"), "argument 2 is missing; write 3: " + std::string{tag.name});
    EXPECT_EQ(fault("(1.5, 4ms, weft, 2)"),
              "there are more than 3 arguments; write (" + std::string{tag.name} + ")");
    EXPECT_EQ(fault("1.5 4ms weft 2"), "\"2\" is left over after the value; remove it");
    EXPECT_EQ(into, Packed{}) << "and nothing was stored";
    for (const char* none : {"", "()", " ( ) "})
        EXPECT_EQ(parse_value(*type_id<Arguments<>>, none, nullptr).view(), "") << none;
}

} // namespace

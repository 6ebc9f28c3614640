// Numbers as decimals: shortest, exact in both directions, in the standard library's layout.
#include "kernel/base/random.hpp"
#include "kernel/base/real_text.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace tappet {
namespace {

template <class Real>
std::string shortest(Real value) {
    char text[max_real_text];
    return {text, write_shortest(text, value)};
}
std::string rounded(double value) {
    char text[max_real_text];
    return {text, write_rounded(text, value, 6)};
}
template <class Real>
std::string of_library(Real value) {
    char text[64];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}
std::string six_of_library(double value) {
    char text[64];
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr};
}

// Whole numbers beyond 2^53 are padded with zeros; the standard library prints the exact value of their bits.
bool is_padded(double value) { return std::fabs(value) >= 9007199254740992.0; }

TEST(RealText, reads_back_every_number_unchanged) {
    Random random{20261121};
    for (int i = 0; i < 100000; ++i) {
        const auto value = std::bit_cast<double>(random.next());
        if (!std::isfinite(value)) continue;
        double back = 0;
        ASSERT_EQ(read_real_text(shortest(value), back), RealTextFault::none) << shortest(value);
        ASSERT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(value)) << shortest(value);
        const auto narrow = std::bit_cast<float>(static_cast<std::uint32_t>(random.next()));
        if (!std::isfinite(narrow)) continue;
        float narrow_back = 0;
        ASSERT_EQ(read_real_text(shortest(narrow), narrow_back), RealTextFault::none) << shortest(narrow);
        ASSERT_EQ(std::bit_cast<std::uint32_t>(narrow_back), std::bit_cast<std::uint32_t>(narrow));
    }
}

TEST(RealText, has_the_layout_of_the_standard_library) {
    Random random{7};
    for (int i = 0; i < 100000; ++i) {
        auto value = std::bit_cast<double>(random.next());
        if (i % 2 == 0)
            value = std::ldexp(static_cast<double>(random.next() >> 11),
                               static_cast<int>(random.next() % 90) - 80);
        if (!std::isfinite(value)) continue;
        if (!is_padded(value)) {
            ASSERT_EQ(shortest(value), of_library(value));
        }
        ASSERT_EQ(rounded(value), six_of_library(value));
    }
    for (const double value :
         {0.0, -0.0, 1.0, 0.1, 1e-4, 1e-5, 100000.0, 1000000.0, 1e15, 123456.7, 1e21, 1e22, 5e-324,
          std::numeric_limits<double>::max(), std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity(), std::nan("")}) {
        EXPECT_EQ(shortest(value), of_library(value));
        EXPECT_EQ(rounded(value), six_of_library(value));
    }
}

TEST(RealText, reports_text_that_is_not_a_number) {
    double value = 7;
    for (const char* text :
         {"",    "-",  ".",   "e5",   "1e", "1e+", "+1",  " 1",  "1 ",   "1.2.3",    "0x10",
          "1,5", "1f", "--1", "nanx", "in", "nan", "NaN", "inf", "-inf", "-Infinity"})
        EXPECT_EQ(read_real_text(text, value), RealTextFault::not_a_number) << text;
    for (const char* text : {"1e400", "-1e400", "1e-400", "1e999999999999999999"})
        EXPECT_EQ(read_real_text(text, value), RealTextFault::out_of_range) << text;
    EXPECT_EQ(value, 7);
    float narrow = 7;
    EXPECT_EQ(read_real_text("1e39", narrow), RealTextFault::out_of_range);
    EXPECT_EQ(read_real_text("1e-60", narrow), RealTextFault::out_of_range);
    EXPECT_EQ(narrow, 7);
}

TEST(RealText, accepts_each_spelling_of_a_number) {
    const struct {
        const char* text;
        double value;
    } cases[] = {{"12", 12},     {"-12", -12},  {".5", 0.5},  {"5.", 5},  {"2e3", 2000},
                 {"2E-3", 2e-3}, {"2e+3", 2e3}, {"0e999", 0}, {"007", 7}, {"0.1", 0.1}};
    for (const auto& each : cases) {
        double value = 1;
        ASSERT_EQ(read_real_text(each.text, value), RealTextFault::none) << each.text;
        EXPECT_EQ(value, each.value) << each.text;
    }
    // A thousand digits, of which the last decides: half way between 1 and its neighbour, plus a little.
    const std::string half =
        "1.00000000000000011102230246251565404236316680908203125" + std::string(1000, '0');
    double value = 0;
    ASSERT_EQ(read_real_text(half, value), RealTextFault::none);
    EXPECT_EQ(value, 1);
    ASSERT_EQ(read_real_text(half + "1", value), RealTextFault::none);
    EXPECT_EQ(value, std::nextafter(1.0, 2.0));
    std::string sevens(2000, '7');
    sevens += "e-1999";
    ASSERT_EQ(read_real_text(sevens, value), RealTextFault::none);
    EXPECT_EQ(value, 7.777777777777778);
}

} // namespace
} // namespace tappet

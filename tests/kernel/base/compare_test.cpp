// Text comparison agrees with the standard library, in constant expressions and at run time.
#include "kernel/base/compare.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace tappet {
namespace {

constexpr std::array<std::string_view, 9> texts{"",     "a",          "b",          "ab",      "unit_1",
                                                "unit", "unit_1.own", "unit_2.own", "\xc3\xa4"};

constexpr int sign(int order) { return order < 0 ? -1 : order > 0 ? 1 : 0; }

constexpr bool agrees(std::string_view a, std::string_view b) {
    return sign(compare_text(a, b)) == sign(a.compare(b)) && same_text(a, b) == (a == b) &&
           find_character(a, '.') == a.find('.');
}

constexpr bool all_agree() {
    for (const std::string_view a : texts)
        for (const std::string_view b : texts)
            if (!agrees(a, b)) return false;
    return true;
}
static_assert(all_agree(), "of static storage, as the names of a table are");

constexpr bool local_characters_agree() {
    const char characters[] = {'u', 'n', 'i', 't'};
    const std::string_view local{characters, sizeof characters};
    return agrees(local, "unit") && agrees("unit_1", local) && agrees(std::string_view{}, local);
}
static_assert(local_characters_agree(), "of a function's own storage, as a sentence's are");

TEST(Characters, compare_at_run_time_as_in_constant_expressions) {
    for (const std::string_view a : texts)
        for (const std::string_view b : texts)
            EXPECT_TRUE(agrees(std::string{a}, std::string{b})) << '"' << a << "\" and \"" << b << '"';
}

} // namespace
} // namespace tappet

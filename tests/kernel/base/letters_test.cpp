// Texts compare as the library's do, in constant expressions and at run time, wherever their letters lie.
#include "kernel/base/letters.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace tappet {
namespace {

constexpr std::array<std::string_view, 9> texts{"",     "a",          "b",          "ab",      "unit_1",
                                                "unit", "unit_1.own", "unit_2.own", "\xc3\xa4"};

constexpr int sign(int order) { return order < 0 ? -1 : order > 0 ? 1 : 0; }

constexpr bool agrees(std::string_view a, std::string_view b) {
    return sign(compare_letters(a, b)) == sign(a.compare(b)) && same_letters(a, b) == (a == b) &&
           find_letter(a, '.') == a.find('.');
}

constexpr bool all_agree() {
    for (const std::string_view a : texts)
        for (const std::string_view b : texts)
            if (!agrees(a, b)) return false;
    return true;
}
static_assert(all_agree(), "of static storage, as the names of a table are");

constexpr bool local_letters_agree() {
    const char letters[] = {'u', 'n', 'i', 't'};
    const std::string_view local{letters, sizeof letters};
    return agrees(local, "unit") && agrees("unit_1", local) && agrees(std::string_view{}, local);
}
static_assert(local_letters_agree(), "of a function's own storage, as a sentence's are");

TEST(Letters, compare_at_run_time_as_in_constant_expressions) {
    for (const std::string_view a : texts)
        for (const std::string_view b : texts)
            EXPECT_TRUE(agrees(std::string{a}, std::string{b})) << '"' << a << "\" and \"" << b << '"';
}

} // namespace
} // namespace tappet

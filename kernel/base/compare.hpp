// Comparison of texts in one step of a constant expression. A table of a thousand components compares ten
// thousand names, which the library does character by character and call by call.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace tappet {

/// As a.compare(b).
constexpr int compare_text(std::string_view a, std::string_view b) noexcept {
    const std::size_t common = std::min(a.size(), b.size());
    // g++ folds this for constants of static storage, such as literals. For others, which are few, it reports
    // that it cannot.
    if (__builtin_constant_p(__builtin_memcmp(a.data(), b.data(), common))) {
        const int order = __builtin_memcmp(a.data(), b.data(), common);
        if (order != 0 || a.size() == b.size()) return order;
        return a.size() < b.size() ? -1 : 1;
    }
    return a.compare(b);
}

/// As a == b.
constexpr bool same_text(std::string_view a, std::string_view b) noexcept {
    return a.size() == b.size() && compare_text(a, b) == 0;
}

/// As text.find(character).
constexpr std::size_t find_character(std::string_view text, char character) noexcept {
    const char* const characters = text.data();
    const std::size_t size = text.size();
    for (std::size_t i = 0; i < size; ++i)
        if (characters[i] == character) return i;
    return std::string_view::npos;
}

} // namespace tappet

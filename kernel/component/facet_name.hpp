// A facet's name assembled by the compiler, for components whose facets follow from a constexpr map.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <string_view>

namespace tappet {

/// Joins pieces of text; more than 63 characters do not compile.
class FacetName {
public:
    static constexpr std::size_t most = 63;

    constexpr FacetName() noexcept = default;
    constexpr FacetName(std::initializer_list<std::string_view> pieces) {
        for (const std::string_view piece : pieces)
            for (const char each : piece) characters_[length_++] = each;
    }
    [[nodiscard]] constexpr std::string_view view() const noexcept { return {characters_.data(), length_}; }

private:
    std::array<char, most> characters_{};
    std::size_t length_ = 0;
};

} // namespace tappet

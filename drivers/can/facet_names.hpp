// What a signal map's facets are called, and of which type their values are.
#pragma once

#include "drivers/can/signal_map.hpp"

#include <array>
#include <string_view>

namespace tappet::can {

/// A signal is a whole number unless a factor, an offset or a float makes it a physical value.
constexpr bool is_integer(const Signal& s) noexcept {
    return s.factor == 1 && s.offset == 0 &&
           (s.kind == Kind::unsigned_integer || s.kind == Kind::signed_integer);
}

/// The names of a map's facets, "frame.signal" and "frame.received", as text that lives as long as the
/// program.
template <const auto& map> struct FacetNames {
    static constexpr std::size_t longest = 63;
    struct Name {
        std::array<char, longest + 1> characters{};
        std::size_t length = 0;
        constexpr void add(std::string_view piece) {
            for (const char character : piece)
                characters[length++] = character; // longer than `longest` does not compile
        }
        [[nodiscard]] constexpr std::string_view view() const noexcept { return {characters.data(), length}; }
    };
    static constexpr auto signals = [] {
        std::array<Name, map.signals.size()> names{};
        for (std::size_t s = 0; s < names.size(); ++s) {
            names[s].add(map.frames[map.frame_of[s]].name);
            names[s].add(".");
            names[s].add(map.signals[s].name);
        }
        return names;
    }();
    static constexpr auto received = [] {
        std::array<Name, map.frames.size()> names{};
        for (std::size_t f = 0; f < names.size(); ++f) {
            names[f].add(map.frames[f].name);
            names[f].add(".received");
        }
        return names;
    }();
};

} // namespace tappet::can

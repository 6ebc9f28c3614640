// What a signal map's facets are called, and of which type their values are.
#pragma once

#include "drivers/can/signal_map.hpp"
#include "kernel/component/facet_name.hpp"

#include <array>

namespace tappet::can {

/// A signal is a whole number unless a factor, an offset or a float makes it a physical value.
constexpr bool is_integer(const Signal& s) noexcept {
    return s.factor == 1 && s.offset == 0 &&
           (s.kind == Kind::unsigned_integer || s.kind == Kind::signed_integer);
}

/// The names of a map's facets, "frame.signal" and "frame.received".
template <const auto& map> struct FacetNames {
    static constexpr auto signals = [] {
        std::array<FacetName, map.signals.size()> names{};
        for (std::size_t s = 0; s < names.size(); ++s)
            names[s] = {map.frames[map.frame_of[s]].name, ".", map.signals[s].name};
        return names;
    }();
    static constexpr auto received = [] {
        std::array<FacetName, map.frames.size()> names{};
        for (std::size_t f = 0; f < names.size(); ++f) names[f] = {map.frames[f].name, ".received"};
        return names;
    }();
};

} // namespace tappet::can

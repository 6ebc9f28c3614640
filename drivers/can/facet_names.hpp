// What a signal map's facets are called, and of which type their values are.
#pragma once

#include "drivers/can/signal_map.hpp"

#include <array>

namespace tappet::can {

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

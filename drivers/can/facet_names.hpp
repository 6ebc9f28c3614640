// The names of a signal map's facets, and the types of their values.
#pragma once

#include "drivers/can/signal_map.hpp"
#include "kernel/base/array_of.hpp"

namespace tappet::can {

/// The names of a map's facets, "frame.signal" and "frame.received".
template <const auto& map> struct FacetNames {
    static constexpr auto signals =
        array_of<map.signals.size()>([](std::size_t s) { return map.name_of(s).facet(); });
    static constexpr auto received =
        array_of<map.frames.size()>([](std::size_t f) { return FacetName{map.frames[f].name, ".received"}; });
};

} // namespace tappet::can

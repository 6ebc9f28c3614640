// How fuzz targets read an input and state their demands.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace tappet::fuzz {

/// Ends the process when the demand fails: a fuzzer notices that.
inline void demand(bool holds) {
    if (!holds) std::abort();
}

/// An input, read from its front as far as it goes.
struct Script {
    std::span<const std::uint8_t> rest;

    std::span<const std::uint8_t> next(std::size_t most) {
        const auto part = rest.first(std::min(most, rest.size()));
        rest = rest.subspan(part.size());
        return part;
    }
};

} // namespace tappet::fuzz

// What fuzz targets do with an input, and what must hold then.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace tappet::fuzz {

/// A fuzzer notices that the process ends.
inline void demand(bool holds) {
    if (!holds) std::abort();
}

/// An input that is taken from its front, as much as there is.
struct Script {
    std::span<const std::uint8_t> rest;

    std::span<const std::uint8_t> next(std::size_t most) {
        const auto part = rest.first(std::min(most, rest.size()));
        rest = rest.subspan(part.size());
        return part;
    }
};

} // namespace tappet::fuzz

// A colour image of a camera, as a port's value.
#pragma once

#include "kernel/base/realtime.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tappet::camera {

struct Colour {
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;

    friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// Pixels row by row from the top.
template <std::size_t columns, std::size_t rows>
struct Image {
    std::array<Colour, columns * rows> pixels{};

    [[nodiscard]] constexpr const Colour& at(std::size_t row, std::size_t column) const noexcept
        TAPPET_REALTIME {
        return pixels[row * columns + column];
    }
};

} // namespace tappet::camera

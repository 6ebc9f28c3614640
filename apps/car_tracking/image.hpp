// A colour image, as the camera passes it to its users.
#pragma once

#include "apps/car_tracking/geometry.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tappet::car_tracking {

struct Colour {
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;

    friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// Pixels row by row from the top, with the aim that the camera believed to have at the exposure.
struct Image {
    Aim aim{};
    std::array<Colour, image_columns * image_rows> pixels{};

    [[nodiscard]] constexpr const Colour& at(std::size_t row, std::size_t column) const noexcept
        TAPPET_REALTIME {
        return pixels[row * image_columns + column];
    }
};

} // namespace tappet::car_tracking

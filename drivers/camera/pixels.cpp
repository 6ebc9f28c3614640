// Whole numbers only: the same colours with every compiler.
#include "drivers/camera/pixels.hpp"

#include <algorithm>

namespace tappet::camera {

namespace {

std::uint8_t in_range(int of_256) noexcept TAPPET_REALTIME {
    return static_cast<std::uint8_t>(std::clamp(of_256 >> 8, 0, 255));
}

/// ITU-R BT.601, limited range: luma 16..235, chroma 16..240.
Colour colour_of(std::byte luma, std::byte blue, std::byte red) noexcept TAPPET_REALTIME {
    const int y = 298 * (std::to_integer<int>(luma) - 16) + 128;
    const int u = std::to_integer<int>(blue) - 128;
    const int v = std::to_integer<int>(red) - 128;
    return {in_range(y + 409 * v), in_range(y - 100 * u - 208 * v), in_range(y + 516 * u)};
}

} // namespace

void decode(const Frame& frame, Size size, std::span<Colour> into) noexcept TAPPET_REALTIME {
    for (std::size_t row = 0; row < size.rows; ++row) {
        const std::byte* from = frame.bytes.data() + row * frame.row_bytes;
        Colour* to = into.data() + row * size.columns;
        if (frame.format == Format::rgb24) {
            for (std::size_t i = 0; i < size.columns; ++i, from += 3)
                to[i] = {std::to_integer<std::uint8_t>(from[0]), std::to_integer<std::uint8_t>(from[1]),
                         std::to_integer<std::uint8_t>(from[2])};
            continue;
        }
        for (std::size_t i = 0; i + 1 < size.columns; i += 2, from += 4) {
            to[i] = colour_of(from[0], from[1], from[3]);
            to[i + 1] = colour_of(from[2], from[1], from[3]);
        }
    }
}

} // namespace tappet::camera

// A camera in the rows of boards and bindings, and the checks of the table.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/device_kind.hpp"

#include <array>

namespace tappet {

namespace camera {

/// The forms of pixels that the driver reads. yuyv: ITU-R BT.601, limited range, as cameras on USB send it.
enum class Format : std::uint8_t { yuyv, rgb24 };
struct FormatRow {
    std::string_view name{};
    std::array<char, 4> code{}; ///< in V4L2
    std::size_t bytes = 0;      ///< of a pixel
};
inline constexpr std::array<FormatRow, 2> formats{
    {{"yuyv", {'Y', 'U', 'Y', 'V'}, 2}, {"rgb24", {'R', 'G', 'B', '3'}, 3}}};
constexpr const FormatRow& row_of(Format format) noexcept {
    return formats[static_cast<std::size_t>(format)];
}

struct Size {
    std::size_t columns = 0, rows = 0;
    bool operator==(const Size&) const = default;
};
inline constexpr std::int64_t most_pixels_a_side = 4096;

inline constexpr Word frames_word{.name = "frames", .kind = "camera"};
inline constexpr Word pixels_word{.name = "pixels", .kind = "camera"};
inline constexpr Word exposure_word{.name = "exposure", .kind = "camera"};

/// Facts of board and binding about a camera.
struct CameraFacts {
    Size size{};
    unsigned per_second = 0;
    Format format = Format::yuyv;
    Duration exposure{}; ///< 0: the camera's own
};
/// Reads the facts of accepted rows.
constexpr CameraFacts camera_facts(std::span<const Fact> of_board, std::span<const Fact> bound) noexcept {
    CameraFacts facts;
    if (const Fact* frames = said(of_board, frames_word); frames != nullptr) {
        facts.size = {static_cast<std::size_t>(frames->numbers[0]),
                      static_cast<std::size_t>(frames->numbers[1])};
        facts.per_second = static_cast<unsigned>(frames->numbers[2]);
    }
    if (const Fact* pixels = said(of_board, pixels_word); pixels != nullptr)
        facts.format = static_cast<Format>(pixels->numbers[0]);
    if (const Fact* exposure = said(bound, exposure_word); exposure != nullptr)
        facts.exposure = Duration{exposure->numbers[0]};
    return facts;
}

/// `asked.parts` has one text: the size of the images that the component takes, "160 x 120".
constexpr Sentence check_camera(const DeviceAsked& asked) {
    const Fact* frames = said(asked.of_board, frames_word);
    if (frames == nullptr)
        return Sentence{"device \"", asked.device,
                        "\" states no size and rate; add frames(640, 480, 30), columns, rows and frames per "
                        "second, to the board's row"};
    const auto [columns, rows, rate] = frames->numbers;
    if (columns < 2 || rows < 2 || columns > most_pixels_a_side || rows > most_pixels_a_side ||
        columns % 2 != 0 || rate < 1 || rate > 1000)
        return Sentence{"device \"",
                        asked.device,
                        "\" states frames(",
                        columns,
                        ", ",
                        rows,
                        ", ",
                        rate,
                        "); write 2 to ",
                        most_pixels_a_side,
                        " columns, an even number, as many rows at most, and 1 to 1000 frames per second"};
    if (said(asked.of_board, pixels_word) == nullptr)
        return Sentence{"device \"", asked.device,
                        "\" states no form of its pixels; add pixels(camera::Format::yuyv) or "
                        "pixels(camera::Format::rgb24) to the board's row"};
    if (const Sentence gives{columns, " x ", rows}; asked.parts.size() != 1 || asked.parts[0] != gives.view())
        return Sentence{
            "device \"",
            asked.device,
            "\" gives images of ",
            gives,
            " pixels and the component takes ",
            asked.parts.empty() ? std::string_view{"none"} : asked.parts[0],
            "; write the same size in the board's frames(...) and in camera::Sensor<columns, rows>"};
    const Fact* exposure = said(asked.bound, exposure_word);
    if (exposure != nullptr &&
        (exposure->numbers[0] < 100'000 || exposure->numbers[0] * rate > 1'000'000'000))
        return Sentence{"exposure(", exposure->numbers[0] / 1000,
                        "us) is less than 100us or longer than a frame at ", rate,
                        " frames per second; write one between"};
    return {};
}

inline constexpr DeviceKind device_kind{.name = "camera", .check = &check_camera};

} // namespace camera

/// Board row: the size of the camera's images in pixels, and their rate: frames(640, 480, 30).
constexpr Fact frames(unsigned columns, unsigned rows, unsigned per_second) noexcept {
    return {&camera::frames_word, {}, {columns, rows, per_second}};
}
/// Board row: the form in which the camera sends its pixels.
constexpr Fact pixels(camera::Format format) noexcept {
    return {&camera::pixels_word, {}, {static_cast<std::int64_t>(format)}};
}
/// Binding row: the exposure of each image, set when the machine starts. Without it the camera's own.
constexpr Fact exposure(Duration time) noexcept { return {&camera::exposure_word, {}, {time.count()}}; }

} // namespace tappet

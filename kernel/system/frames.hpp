// The frames on the wire that are made from a system's rows, and the place of each row in them.
#pragma once

#include "kernel/base/response.hpp"
#include "kernel/component/device_traffic.hpp"
#include "kernel/system/resolve.hpp"

namespace tappet {

/// The purpose of a frame.
enum class WireFrameKind : std::uint8_t {
    beat,     ///< of a node: it lives, and this is the layout of one of its rows
    data,     ///< values of one node, with one period
    message,  ///< an event or a command
    answer,   ///< to a message
    reply,    ///< the result of a command
    received, ///< the answer to a reply
    sync,     ///< the common clock: the end of this frame is a moment
    follow_up ///< that moment by the teller's clock
};

struct WireFrame {
    std::size_t node = nowhere; ///< the sender
    WireFrameKind kind = WireFrameKind::beat;
    std::size_t crossing = nowhere; ///< of data: the first crossing in it
    Duration apart{};               ///< the shortest time between two
    Duration on_wire{};             ///< the longest transmission time
    Duration deadline{};    ///< from its release, which its node serves in time, to its end on the wire
    Duration worst{};       ///< the proven time from its release to its end
    Duration jitter{};      ///< its jitter for other nodes
    std::uint16_t bits = 0; ///< of its contents, including the protection
    std::uint8_t bytes = 0; ///< its length on the wire
    std::uint32_t id = 0;
    std::uint16_t data_id = 0; ///< protects it against being taken for another frame

    [[nodiscard]] constexpr bool is_of_clock() const noexcept {
        return kind == WireFrameKind::sync || kind == WireFrameKind::follow_up;
    }
};

/// The layout of a wire's frames: first the protection, which is CRC and counter. Then either values, or four
/// bits for the kind of the frame and, from the next whole byte on, the rest.
struct WireShape {
    std::uint16_t most_bits = 64, protection_bits = 12, head_bits = 16;

    /// Bits of a channel's frame before its contents: its kind, number and session.
    [[nodiscard]] constexpr std::uint16_t channel_bits() const noexcept {
        return static_cast<std::uint16_t>(head_bits + 16);
    }
    [[nodiscard]] constexpr std::uint16_t beat_bits() const noexcept {
        return static_cast<std::uint16_t>(head_bits + 48);
    }
};
constexpr WireShape shape_of(const WireRow& wire) noexcept {
    return wire.is_fd() ? WireShape{512, 24, 32} : WireShape{};
}

/// The place of a row on the wire.
struct CrossingPlace {
    std::size_t frame = nowhere; ///< of the data, or of the message
    std::size_t answer = nowhere, reply = nowhere, received = nowhere;
    std::uint16_t at = 0; ///< of data: its first bit
};

/// Proves frames that are in the order of their priority on the wire. Fills `worst` and `bytes` of each;
/// returns the first frame that misses its deadline, or the number of frames.
using WireAnalysis = std::size_t (*)(const SystemView&, std::span<WireFrame>);

template <std::size_t N, std::size_t X>
struct SystemPlan {
    static constexpr std::size_t most_frames = N + 2 + 4 * X;
    WireShape shape{};
    Duration clock_error{}; ///< of the common clock, while no exchange is lost
    Sentence fault{};       ///< empty when the check of the wire found no fault
    std::array<CrossingIndex, X> index{};
    std::array<CrossingPlace, X> place{};
    Bounded<WireFrame, most_frames> frames{}; ///< the most urgent first
};

} // namespace tappet

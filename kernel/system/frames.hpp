// The frames that a system's rows become on the wire, and where in them each row stands.
#pragma once

#include "kernel/base/response.hpp"
#include "kernel/component/device_traffic.hpp"
#include "kernel/system/resolve.hpp"

namespace tappet {

/// What a frame is for.
enum class WireFrameKind : std::uint8_t {
    beat,     ///< of a node: it lives, and so one of its rows looks
    data,     ///< values of one node, of one period
    message,  ///< an event, or a command that was sent
    answer,   ///< to those
    reply,    ///< how a command went
    received, ///< the answer to that
    sync,     ///< the common clock is told: this frame is through,
    follow_up ///< and then that was so by the teller's clock
};

struct WireFrame {
    std::size_t node = nowhere; ///< who sends it
    WireFrameKind kind = WireFrameKind::beat;
    std::size_t crossing = nowhere; ///< of data the first one in it
    Duration apart{};               ///< the least time between two
    Duration on_wire{};             ///< the longest that one takes there
    Duration deadline{};    ///< from its release, which its node serves in time, to its end on the wire
    Duration worst{};       ///< likewise, proven
    Duration jitter{};      ///< by how much it may be late, for other nodes
    std::uint16_t bits = 0; ///< of its contents, protection included
    std::uint8_t bytes = 0; ///< that it has on the wire
    std::uint32_t id = 0;
    std::uint16_t data_id = 0; ///< protects it against being taken for another one

    [[nodiscard]] constexpr bool is_of_clock() const noexcept {
        return kind == WireFrameKind::sync || kind == WireFrameKind::follow_up;
    }
};

/// How the frames of a wire are laid out: their protection, which is CRC and counter; then values, or four
/// bits that say what it is and from a whole byte on the rest.
struct WireShape {
    std::uint16_t most_bits = 64, protection_bits = 12, head_bits = 16;

    /// Of a channel's frame, before its contents: what it is, its number and session.
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

/// Where a row stands on the wire.
struct CrossingPlace {
    std::size_t frame = nowhere; ///< data, or the message
    std::size_t answer = nowhere, reply = nowhere, received = nowhere;
    std::uint16_t at = 0; ///< of data: its first bit
};

/// Proves frames that stand in the order in which they win the wire. `worst` and `bytes` of each are written;
/// the answer is the first that is not within its deadline, or how many there are.
using WireAnalysis = std::size_t (*)(const SystemView&, std::span<WireFrame>);

template <std::size_t N, std::size_t X>
struct SystemPlan {
    static constexpr std::size_t most_frames = N + 2 + 4 * X;
    WireShape shape{};
    Duration clock_error{}; ///< of the common clock, while no exchange is lost
    Sentence fault{};       ///< empty when everything about the wire is right
    std::array<CrossingIndex, X> index{};
    std::array<CrossingPlace, X> place{};
    Bounded<WireFrame, most_frames> frames{}; ///< the most urgent first
};

} // namespace tappet

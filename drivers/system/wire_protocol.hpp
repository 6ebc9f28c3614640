// The contents of the frames between the nodes of a system, after their protection.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/system/channel.hpp"
#include "kernel/system/plan.hpp"

#include <array>
#include <cstdint>

namespace tappet::systems {

using Contents = std::span<const std::uint8_t>; ///< of a frame, with the wire's maximum length
using Payload = std::span<std::uint8_t>;        ///< the same, to be written

/// A node's beat: that it runs, the number of its start, and the layout of one of its rows.
struct Beat {
    bool runs = false; ///< false: it stops, and says so once
    std::uint16_t epoch = 0;
    std::uint16_t row = 0;
    std::uint16_t layout = 0;
};

// Four bits after the protection state the meaning; the rest is in bytes, the low one first. All real-time.
constexpr void put_word(const WireShape& shape, Payload into, std::uint8_t word) noexcept TAPPET_REALTIME {
    on_wire::put_bits(into, shape.protection_bits, 4, word);
}
constexpr std::uint8_t word_of(const WireShape& shape, Contents from) noexcept TAPPET_REALTIME {
    return static_cast<std::uint8_t>(on_wire::take_bits(from, shape.protection_bits, 4));
}
constexpr void put_beat(const WireShape& shape, Payload into, const Beat& beat) noexcept TAPPET_REALTIME {
    put_word(shape, into, beat.runs ? 1 : 0);
    std::size_t at = shape.head_bits;
    for (const std::uint16_t each : {beat.epoch, beat.row, beat.layout}) {
        on_wire::put_bits(into, at, 16, each);
        at += 16;
    }
}
constexpr Beat beat_of(const WireShape& shape, Contents from) noexcept TAPPET_REALTIME {
    const auto number = [&](std::size_t i) noexcept TAPPET_REALTIME {
        return static_cast<std::uint16_t>(on_wire::take_bits(from, shape.head_bits + 16 * i, 16));
    };
    return {word_of(shape, from) == 1, number(0), number(1), number(2)};
}

/// The head of a channel's frames, ahead of their contents.
struct ChannelHead {
    ChannelWord word{};
    std::uint8_t number = 0;
    std::uint8_t session = 0;
};
constexpr void put_head(const WireShape& shape, Payload into, const ChannelHead& head) noexcept
    TAPPET_REALTIME {
    put_word(shape, into, static_cast<std::uint8_t>(head.word));
    into[shape.head_bits / 8u] = head.number;
    into[shape.head_bits / 8u + 1] = head.session;
}
constexpr ChannelHead head_of(const WireShape& shape, Contents from) noexcept TAPPET_REALTIME {
    return {static_cast<ChannelWord>(word_of(shape, from)), from[shape.head_bits / 8u],
            from[shape.head_bits / 8u + 1]};
}

} // namespace tappet::systems

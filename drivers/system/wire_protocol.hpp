// What stands in the frames between the nodes of a system, after their protection.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/system/channel.hpp"
#include "kernel/system/plan.hpp"

#include <array>
#include <cstdint>

namespace tappet::systems {

using Payload = std::array<std::uint8_t, most_wire_bits / 8>;
using Contents = std::span<const std::uint8_t>; ///< of a frame, as long as a Payload

/// Of a node: that it lives, which start of it this is, and how one of its rows stands on the wire there.
struct Beat {
    bool runs = false; ///< false: it stops, and says so once
    std::uint16_t epoch = 0;
    std::uint16_t row = 0;
    std::uint16_t layout = 0;
};

// Bits 12 to 15 say what it is; the rest stands in bytes, the low one first. All real-time.
constexpr void put_word(Payload& into, std::uint8_t word) noexcept TAPPET_REALTIME {
    on_wire::put_bits(into, 12, 4, word);
}
constexpr std::uint8_t word_of(Contents from) noexcept TAPPET_REALTIME {
    return static_cast<std::uint8_t>(on_wire::take_bits(from, 12, 4));
}
constexpr void put_beat(Payload& into, const Beat& beat) noexcept TAPPET_REALTIME {
    put_word(into, beat.runs ? 1 : 0);
    on_wire::put_bits(into, 16, 16, beat.epoch);
    on_wire::put_bits(into, 32, 16, beat.row);
    on_wire::put_bits(into, 48, 16, beat.layout);
}
constexpr Beat beat_of(Contents from) noexcept TAPPET_REALTIME {
    return {word_of(from) == 1, static_cast<std::uint16_t>(on_wire::take_bits(from, 16, 16)),
            static_cast<std::uint16_t>(on_wire::take_bits(from, 32, 16)),
            static_cast<std::uint16_t>(on_wire::take_bits(from, 48, 16))};
}

/// The head of a channel's frames, before arguments from bit 32 on.
struct ChannelHead {
    ChannelWord word{};
    std::uint8_t number = 0;
    std::uint8_t session = 0;
};
constexpr void put_head(Payload& into, const ChannelHead& head) noexcept TAPPET_REALTIME {
    put_word(into, static_cast<std::uint8_t>(head.word));
    into[2] = head.number;
    into[3] = head.session;
}
constexpr ChannelHead head_of(Contents from) noexcept TAPPET_REALTIME {
    return {static_cast<ChannelWord>(word_of(from)), from[2], from[3]};
}

} // namespace tappet::systems

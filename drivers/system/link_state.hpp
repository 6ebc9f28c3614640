// The state that a node's end of the wire keeps of other nodes and of its rows.
#pragma once

#include "kernel/system/channel.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tappet::systems {

/// The state of another node, as received.
struct LinkPeer {
    bool there = false;
    std::uint16_t epoch = 0;
    Time silent_at = never;
    Time begun = Time::min();    ///< when its present start was first heard
    std::uint16_t first_row = 0; ///< the first row it announced
    std::uint8_t rounds = 0;     ///< how often it announced all its rows
    bool has_told = false;
};

/// State of a command sent from here.
enum class LinkCall : std::uint8_t { none, wanted, offered, done, failed };

template <std::size_t most_bytes>
struct LinkRow {
    bool agreed = false;
    bool is_refused = false;
    bool was_valid = false;     ///< a value of it arrived
    ChannelSender sender{};     ///< of events and commands to others, and of replies
    ChannelReceiver receiver{}; ///< the opposite direction
    LinkCall call = LinkCall::none;
    std::uint8_t asked = 0;       ///< the number it was sent with
    bool serves = false;          ///< a command of another node executes here ..
    std::uint8_t serving = 0;     ///< .. sent with this number
    bool refuses = false;         ///< another command arrived in the meantime ..
    std::uint8_t refused = 0;     ///< .. sent with this number
    Time may_offer = Time::min(); ///< earliest time of the next one, by its at_most(...)
    bool is_held = false;         ///< one waits for that time, in `values`
    std::array<std::byte, most_bytes> values{};

    [[nodiscard]] bool is_under_way() const noexcept TAPPET_REALTIME {
        return call == LinkCall::wanted || call == LinkCall::offered;
    }
};

} // namespace tappet::systems

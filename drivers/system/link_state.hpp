// What a node's end of the wire knows of other nodes and of its rows.
#pragma once

#include "kernel/system/channel.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tappet::systems {

/// Another node, as it is heard.
struct LinkPeer {
    bool there = false;
    std::uint16_t epoch = 0;
    Time silent_at = never;
    Time begun = Time::min();    ///< this start of it was heard first
    std::uint16_t first_row = 0; ///< that it told of
    std::uint8_t rounds = 0;     ///< it told of all its rows so often
    bool has_told = false;
};

/// Of a command that was sent from here.
enum class LinkCall : std::uint8_t { none, wanted, offered, done, failed };

template <std::size_t most_bytes>
struct LinkRow {
    bool agreed = false;
    bool is_refused = false;
    bool was_valid = false;     ///< a value of it came
    ChannelSender sender{};     ///< of events and commands to others, and of replies
    ChannelReceiver receiver{}; ///< the other way
    LinkCall call = LinkCall::none;
    std::uint8_t asked = 0;       ///< the number by which it was sent
    bool serves = false;          ///< a command of another node is under way here,
    std::uint8_t serving = 0;     ///< sent by this number
    bool refuses = false;         ///< another one came meanwhile,
    std::uint8_t refused = 0;     ///< by this one
    Time may_offer = Time::min(); ///< the next one, by its at_most(...)
    bool is_held = false;         ///< one waits for that, in `values`
    std::array<std::byte, most_bytes> values{};

    [[nodiscard]] bool is_under_way() const noexcept TAPPET_REALTIME {
        return call == LinkCall::wanted || call == LinkCall::offered;
    }
};

} // namespace tappet::systems

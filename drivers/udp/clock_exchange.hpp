// How far another machine's clock is ahead, from requests and replies between the two: guaranteed bounds, not
// estimates.
#pragma once

#include "kernel/base/clock_bounds.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tappet::udp {

/// The four times of a request and its reply: two of the requester's clock, two of the other one.
struct ClockTimes {
    Time asked{}, received{}, answered{}, got{};
};

/// A request arrives after it was sent, and so does its reply. Therefore the other clock is ahead by no less
/// than `answered - got` and no more than `received - asked`. Each exchange narrows these bounds; with age
/// they widen by the possible drift of the two clocks. Real-time.
class ClockExchange : public ClockBounds {
public:
    /// `drift`: the largest drift of one clock against the other, in seconds per second.
    void take(const ClockTimes& times, double drift) noexcept TAPPET_REALTIME {
        age(times.got, drift);
        narrow(times.answered - times.got,
               times.received - times.asked + parted(times.got - times.asked, drift));
    }
};

/// Request and reply have the same form, little-endian: u32 "clk1", u32 number, and three of the times in ns;
/// those of the other clock are 0 in a request.
namespace clock_packet {

inline constexpr std::uint32_t mark = 0x316b6c63;
inline constexpr std::size_t bytes = 2 * sizeof(std::uint32_t) + 3 * sizeof(std::int64_t);
using Packet = std::array<std::byte, bytes>;
inline constexpr Duration longest = 36500 * 24h; ///< the longest a machine runs, so that differences cannot
                                                 ///< overflow

struct Content {
    std::uint32_t number = 0;
    Time asked{}, received{}, answered{};
    [[nodiscard]] bool is_question() const noexcept TAPPET_REALTIME { return answered == Time{}; }
};

inline Packet write(const Content& content) noexcept TAPPET_REALTIME {
    const std::array<std::uint32_t, 2> head{mark, content.number};
    const std::array<std::int64_t, 3> times{to_ns(content.asked), to_ns(content.received),
                                            to_ns(content.answered)};
    Packet packet;
    std::memcpy(packet.data(), head.data(), sizeof head);
    std::memcpy(packet.data() + sizeof head, times.data(), sizeof times);
    return packet;
}
/// Returns false when it is not a clock packet.
[[nodiscard]] inline bool read(std::span<const std::byte> packet, Content& content) noexcept TAPPET_REALTIME {
    std::array<std::uint32_t, 2> head{};
    std::array<std::int64_t, 3> times{};
    if (packet.size() != bytes) return false;
    std::memcpy(head.data(), packet.data(), sizeof head);
    std::memcpy(times.data(), packet.data() + sizeof head, sizeof times);
    content = {head[1], at_ns(times[0]), at_ns(times[1]), at_ns(times[2])};
    return head[0] == mark && std::ranges::all_of(times, [](std::int64_t each) noexcept TAPPET_REALTIME {
               return -to_ns(Time{longest}) <= each && each <= to_ns(Time{longest});
           });
}

} // namespace clock_packet

} // namespace tappet::udp

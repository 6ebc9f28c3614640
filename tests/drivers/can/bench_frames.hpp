// Frames to and from the real SocketCAN device on the bench.
#pragma once

#include "drivers/can/signal_map.hpp"
#include "drivers/can/socket_can.hpp"
#include "kernel/os/clock.hpp"

#include <array>
#include <thread>
#include <vector>

namespace tappet::can {

template <std::size_t N> constexpr std::array<Identifier, N> from_200 = [] {
    std::array<Identifier, N> all{};
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = standard(0x200 + i);
    return all;
}();

inline Time now() { return os::Clock::monotonic(); }

/// Its bytes count up from its identifier.
inline Frame numbered(Identifier id, Format format, std::uint8_t length = 64) {
    Frame f{.id = id.id, .extended = id.extended, .length = length, .stamp = now()};
    set_format(f, format);
    for (std::size_t i = 0; i < length; ++i) f.data[i] = static_cast<std::uint8_t>(id.id + i);
    return f;
}

/// Reads and serves for a while; returns the frames that came.
inline std::vector<Frame> heard_by(SocketCan& end, Duration how_long) {
    std::vector<Frame> all;
    for (const Time until = now() + how_long; now() < until;) {
        Frame f;
        const Receive got = end.receive(f);
        if (got.what == Received::frame) all.push_back(f);
        end.service(now());
        if (got.what == Received::none) std::this_thread::sleep_for(1ms);
    }
    return all;
}

} // namespace tappet::can

// Frames of a bus that are no signals: those that the protocol above it takes and sends itself.
#pragma once

#include "drivers/can/signal_map.hpp"

#include <algorithm>
#include <type_traits>

namespace tappet::can {

/// The identifiers that a protocol keeps for itself, and the frames that make its nodes safe when the
/// machine's process is no more.
template <std::size_t R, std::size_t T, std::size_t S> struct Services {
    std::array<Identifier, R> receive{};
    std::array<Identifier, T> transmit{};
    std::array<Frame, S> safe{};
    static constexpr bool any = R + T + S != 0;

    [[nodiscard]] constexpr bool takes(const Frame& frame) const noexcept TAPPET_REALTIME {
        for (const Identifier& one : receive)
            if (one.id == frame.id && one.extended == frame.extended) return !frame.remote;
        return false;
    }
};
inline constexpr Services<0, 0, 0> no_services{};

/// What one end of the bus takes and sends, of a map and of services together.
template <const auto& map, const auto& services> struct AllIdentifiers {
    template <std::size_t N, class T, std::size_t M>
    static constexpr auto joined(std::span<const T> first, const std::array<T, M>& second) {
        std::array<T, N + M> all{};
        std::copy(second.begin(), second.end(), std::copy(first.begin(), first.end(), all.begin()));
        return all;
    }
    static constexpr auto receive = joined<map.received_count>(map.receives(), services.receive);
    static constexpr auto transmit = joined<map.transmitted_count>(map.transmits(), services.transmit);
    static constexpr auto safe = joined<map.safe_count>(map.safe_frames(), services.safe);
    static constexpr Identifiers value{receive, transmit, safe, map.frames, map.signals};
};

/// A port that is there when there are services.
template <bool any, class Port> struct NoPort {};
template <bool any, class Port> using ServicePort = std::conditional_t<any, Port, NoPort<any, Port>>;

} // namespace tappet::can

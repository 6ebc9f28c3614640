// Frames of a bus without signals: those that a protocol above it receives and sends itself.
#pragma once

#include "drivers/can/signal_map.hpp"
#include "kernel/component/device_traffic.hpp"

#include <algorithm>
#include <type_traits>

namespace tappet::can {

/// The frames that a protocol reserves, and those that make its nodes safe after the machine's process has
/// ended. A row without a rate is not part of the bus's timing proof: it is sent only after a fault.
template <std::size_t N, std::size_t S, std::size_t G = 0> struct Services {
    std::array<FrameRow, N> frames{};
    std::array<Signal, G> signals{}; ///< their signals, for tools; each row states its first and how many
    std::array<Frame, S> safe{};
    std::uint32_t bit_rate = 0;         ///< bit rate of their proof, in bit/s; 0: any rate of the board
    std::uint32_t data_bit_rate = 0;    ///< the same for CAN FD's data phase
    std::uint32_t restarts_allowed = 0; ///< of a faulted controller; 0: the default of Settings
    bool sends_itself = false;          ///< uses the device next to the bus; else by the bus's to_send
    static constexpr bool any = N + S != 0;

    /// Returns whether some of its frames are sent by the bus's input to_send.
    [[nodiscard]] constexpr bool sends_by_bus() const noexcept {
        return !sends_itself && std::ranges::count(frames, Direction::transmit, &FrameRow::direction) != 0;
    }
    [[nodiscard]] constexpr bool takes(const Frame& frame) const noexcept TAPPET_REALTIME {
        for (const FrameRow& row : frames)
            if (row.direction == Direction::receive && row.identifier == Identifier{frame.id, frame.extended})
                return !frame.remote && format_of(frame) == row.format;
        return false;
    }
};
inline constexpr Services<0, 0> no_services{};

/// Joins two protocols on one bus. Each receives its own frames; at most one is proven for a bit rate of its
/// own, or both for the same.
template <std::size_t N, std::size_t S, std::size_t G, std::size_t M, std::size_t T, std::size_t H>
constexpr Services<N + M, S + T, G + H> together(const Services<N, S, G>& one,
                                                 const Services<M, T, H>& other) noexcept {
    Services<N + M, S + T, G + H> both{};
    const auto join = [](const auto& first, const auto& then, auto& into) {
        std::copy(then.begin(), then.end(), std::copy(first.begin(), first.end(), into.begin()));
    };
    join(one.frames, other.frames, both.frames);
    join(one.safe, other.safe, both.safe);
    join(one.signals, other.signals, both.signals);
    for (std::size_t f = N; f < N + M; ++f) both.frames[f].first += G;
    both.bit_rate = std::max(one.bit_rate, other.bit_rate);
    both.data_bit_rate = std::max(one.data_bit_rate, other.data_bit_rate);
    both.restarts_allowed = std::max(one.restarts_allowed, other.restarts_allowed);
    both.sends_itself = !one.sends_by_bus() && !other.sends_by_bus();
    return both;
}

/// The frames that one end of the bus receives and sends, of map and services together.
template <const auto& map, const auto& services> struct AllFrames {
    template <std::size_t N, class T, std::size_t M>
    static constexpr auto joined(std::span<const T> first, const std::array<T, M>& second) {
        std::array<T, N + M> all{};
        std::copy(second.begin(), second.end(), std::copy(first.begin(), first.end(), all.begin()));
        return all;
    }
    template <std::size_t N, class Wanted> static constexpr auto chosen(const Wanted& is_wanted) {
        std::array<FrameRow, N> some{};
        std::size_t n = 0;
        for (const FrameRow& row : services.frames)
            if (is_wanted(row)) some[n++] = row;
        return some;
    }
    template <std::size_t N> static constexpr auto identifiers(Direction direction) {
        std::array<Identifier, N> some{};
        std::size_t n = 0;
        for (const FrameRow& row : services.frames)
            if (row.direction == direction) some[n++] = row.identifier;
        return some;
    }
    static constexpr std::size_t count(Direction direction) {
        return static_cast<std::size_t>(std::ranges::count(services.frames, direction, &FrameRow::direction));
    }
    static constexpr bool has_rate(const FrameRow& row) { return row.apart > Duration::zero(); }
    static constexpr auto rated =
        static_cast<std::size_t>(std::ranges::count_if(services.frames, &AllFrames::has_rate));

    static constexpr auto receive = joined<map.received_count>(
        map.receives(), identifiers<count(Direction::receive)>(Direction::receive));
    static constexpr auto transmit = joined<map.transmitted_count>(
        map.transmits(), identifiers<count(Direction::transmit)>(Direction::transmit));
    static constexpr auto safe = joined<map.safe_count>(map.safe_frames(), services.safe);
    static constexpr bool is_fd(const FrameRow& row) { return row.format != Format::classical; }
    static constexpr bool has_fd = std::ranges::any_of(map.frames, &AllFrames::is_fd) ||
                                   std::ranges::any_of(services.frames, &AllFrames::is_fd);
    /// Frames shown to tools: the map's, and the services' when they state their signals.
    static constexpr auto told_frames = [] {
        constexpr std::size_t own = map.frames.size();
        constexpr bool all = services.signals.size() != 0;
        std::array<FrameRow, own + (all ? services.frames.size() : 0)> rows{};
        std::copy(map.frames.begin(), map.frames.end(), rows.begin());
        for (std::size_t f = own; f < rows.size(); ++f) {
            rows[f] = services.frames[f - own];
            rows[f].first += map.signals.size();
        }
        return rows;
    }();
    static constexpr auto told_signals =
        joined<map.signals.size()>(std::span<const Signal>{map.signals}, services.signals);
    static constexpr Identifiers value{
        receive, transmit, has_fd, safe, told_frames, told_signals, services.restarts_allowed};
    /// The frame that the bus must be served for most often: those of the map, and those that it sends for a
    /// protocol; what a protocol receives is buffered.
    static constexpr DevicePace pace = [] {
        DevicePace fastest;
        const auto consider = [&](const FrameRow& row) {
            if (has_rate(row) && (fastest.apart == Duration::zero() || row.apart < fastest.apart))
                fastest = {row.name, row.apart};
        };
        for (const FrameRow& row : map.frames)
            if (row.direction != Direction::passing) consider(row);
        for (const FrameRow& row : services.frames)
            if (row.direction == Direction::transmit && !services.sends_itself) consider(row);
        return fastest;
    }();
    /// The frames in the bus's timing proof.
    static constexpr auto traffic =
        joined<map.frames.size()>(std::span<const FrameRow>{map.frames}, chosen<rated>(&AllFrames::has_rate));
};

/// A port that exists only with services.
template <bool any, class Port> struct NoPort {};
template <bool any, class Port> using ServicePort = std::conditional_t<any, Port, NoPort<any, Port>>;

} // namespace tappet::can

// The signals of a CAN bus as one constexpr table, and what the compiler finds wrong with it.
#pragma once

#include "drivers/can/frame.hpp"
#include "drivers/can/signal.hpp"
#include "kernel/base/text.hpp"

#include <concepts>
#include <cstddef>
#include <span>

namespace tappet::can {

enum class Direction : std::uint8_t { receive, transmit };

/// A row of the table.
struct FrameRow {
    Identifier identifier{};
    std::string_view name{};
    Direction direction = Direction::receive;
    std::uint8_t length = 0;
    Duration every{};      ///< the period; 0: sent on demand, and all of them in order
    Duration apart{};      ///< the least time between two; 0: the row does not say it
    Duration jitter{};     ///< receive: by how much its node may be late
    std::size_t first = 0; ///< its signals in the map's array
    std::size_t signals = 0;
    bool silence_is_safe = false; ///< transmit: it is not sent when the machine's process is no more
};

/// A row together with its signals, before the map flattens them.
template <std::size_t N> struct FrameWithSignals {
    FrameRow row{};
    std::array<Signal, N> signals{};

    /// Instead of safe values: whoever receives this frame is safe without it, by a time-out of its own.
    constexpr FrameWithSignals safe_by_silence() const noexcept {
        FrameWithSignals copy = *this;
        copy.row.silence_is_safe = true;
        return copy;
    }
};

/// The identifier of a row: standard(0x181), extended(0x18FF0102).
constexpr Identifier standard(std::uint32_t id) noexcept { return {id, false}; }
/// Likewise, of 29 bits.
constexpr Identifier extended(std::uint32_t id) noexcept { return {id, true}; }

struct Bytes {
    std::uint8_t count = 0;
};
/// Length of the frame, 8 at most.
constexpr Bytes bytes(std::uint8_t count) noexcept { return {count}; }
/// How often a frame comes, which the bus's response times are computed from.
struct Rate {
    Duration every{}, apart{}, jitter{};
};
/// With this period. Of a received one, how much later than that its node may send it.
constexpr Rate every(Duration period, Duration jitter = {}) noexcept { return {period, period, jitter}; }
/// When one of its values was written, and all of them in order; of a received one, when its node has
/// something to tell. Two of them are believed to be so far apart; of what is sent a breach is counted.
constexpr Rate on_demand(Duration apart) noexcept { return {{}, apart, {}}; }

/// receive(standard(0x181), "main_drive", bytes(6), every(2ms), signal("statusword", 0, 16), ...)
/// How old a value may grow is said by the connection's row that reads it.
template <class... Signals>
constexpr auto receive(Identifier id, std::string_view name, Bytes length, Rate rate,
                       const Signals&... signals) noexcept {
    return FrameWithSignals<sizeof...(Signals)>{{id, name, Direction::receive, length.count, rate.every,
                                                 rate.apart, rate.jitter, 0, sizeof...(Signals)},
                                                {signals...}};
}
/// Without its rate, which the map's check asks for.
template <class... Signals>
    requires(std::same_as<Signals, Signal> && ...)
constexpr auto receive(Identifier id, std::string_view name, Bytes length,
                       const Signals&... signals) noexcept {
    return receive(id, name, length, Rate{}, signals...);
}
/// transmit(standard(0x201), "main_drive_command", bytes(6), every(1ms), signal("controlword", 0,
/// 16).safe(2), ...)
template <class... Signals>
constexpr auto transmit(Identifier id, std::string_view name, Bytes length, Rate rate,
                        const Signals&... signals) noexcept {
    return FrameWithSignals<sizeof...(Signals)>{{id, name, Direction::transmit, length.count, rate.every,
                                                 rate.apart, rate.jitter, 0, sizeof...(Signals)},
                                                {signals...}};
}

inline constexpr std::size_t no_such = ~std::size_t{0};

/// What one end of a bus takes and sends, and what it sends last.
struct Identifiers {
    std::span<const Identifier> receive{}, transmit{};
    std::span<const Frame> safe{}; ///< see SignalMap::safe_frames
};

template <std::size_t F, std::size_t S> struct SignalMap {
    std::array<FrameRow, F> frames{};
    std::array<Signal, S> signals{};
    std::array<std::size_t, S> frame_of{}; ///< the frame that holds a signal
    std::array<Identifier, F> received{};  ///< the first `received_count` are valid
    std::array<Identifier, F> transmitted{};
    /// What makes the receivers safe when the machine's process is no more: the cyclic ones first, whose
    /// receivers are told what to do before those on demand tell them what to be.
    std::array<Frame, F> safe{};
    std::size_t received_count = 0;
    std::size_t transmitted_count = 0;
    std::size_t safe_count = 0;
    Sentence fault{}; ///< empty when the table is right

    /// What Settings::receive and Settings::transmit take; the map must outlive them.
    [[nodiscard]] constexpr std::span<const Identifier> receives() const noexcept {
        return std::span{received}.first(received_count);
    }
    [[nodiscard]] constexpr std::span<const Identifier> transmits() const noexcept {
        return std::span{transmitted}.first(transmitted_count);
    }
    [[nodiscard]] constexpr std::span<const Frame> safe_frames() const noexcept {
        return std::span{safe}.first(safe_count);
    }
    [[nodiscard]] constexpr std::size_t frame(Identifier id) const noexcept TAPPET_REALTIME {
        for (std::size_t f = 0; f < F; ++f)
            if (frames[f].identifier == id) return f;
        return no_such;
    }
    [[nodiscard]] constexpr std::size_t frame(std::string_view name) const noexcept {
        for (std::size_t f = 0; f < F; ++f)
            if (frames[f].name == name) return f;
        return no_such;
    }
    /// By "frame.signal".
    [[nodiscard]] constexpr std::size_t signal(std::string_view path) const noexcept {
        for (std::size_t s = 0; s < S; ++s) {
            const std::string_view owner = frames[frame_of[s]].name;
            if (path.size() == owner.size() + 1 + signals[s].name.size() && path.starts_with(owner) &&
                path[owner.size()] == '.' && path.ends_with(signals[s].name))
                return s;
        }
        return no_such;
    }
};

namespace detail {

constexpr Sentence signal_fault(const FrameRow& frame, const Signal& s) noexcept {
    const Sentence who{"signal \"", frame.name, ".", s.name, "\""};
    if (s.name.empty()) return Sentence{"frame \"", frame.name, "\" has a signal without a name: name it"};
    if (s.bits == 0 || s.bits > 64) return Sentence{who, " has ", unsigned{s.bits}, " bits: give it 1 to 64"};
    if (s.kind == Kind::float32 && s.bits != 32)
        return Sentence{who, " is a float of ", unsigned{s.bits}, " bits: give it 32 or 64"};
    if (s.factor == 0 || s.factor != s.factor)
        return Sentence{who, " has the factor 0: every value would be the offset; give it another"};
    const unsigned end = 8u * frame.length;
    const unsigned low = bit_place(s, 0);
    const unsigned high = bit_place(s, s.bits - 1u);
    if (s.start >= end || low >= end || high >= end)
        return Sentence{who,
                        " reaches outside its frame of ",
                        unsigned{frame.length},
                        " bytes: it starts at bit ",
                        unsigned{s.start},
                        s.order == Order::intel ? " (its lowest) and goes up "
                                                : " (its highest) and goes down ",
                        unsigned{s.bits},
                        " bits; move it or lengthen the frame"};
    return {};
}

constexpr Sentence safe_fault(const FrameRow& frame, const Signal& s) noexcept {
    const Sentence who{"signal \"", frame.name, ".", s.name, "\""};
    if (frame.direction == Direction::receive)
        return s.says_safe ? Sentence{who, " is received and has a safe value: only what is sent has one"}
                           : Sentence{};
    if (s.says_safe == frame.silence_is_safe)
        return s.says_safe
                   ? Sentence{who, " has a safe value, but its frame is safe by silence: keep one of the two"}
                   : Sentence{who, " does not say its safe value: write .safe(..) behind it, or "
                                   ".safe_by_silence() behind the frame"};
    if (const Raw raw = to_raw(s, s.safe_value); s.says_safe && (raw.saturated || raw.refused))
        return Sentence{who, " cannot hold its safe value: it is outside of the signal's range"};
    return {};
}

constexpr Sentence rate_fault(const FrameRow& frame) noexcept {
    const Sentence who{"frame \"", frame.name, "\""};
    if (frame.apart <= Duration::zero())
        return Sentence{who, " does not say how often it comes: write can::every(10ms) behind its length, or "
                             "can::on_demand(10ms) with the least time between two"};
    if (frame.jitter < Duration::zero() ||
        (frame.jitter > Duration::zero() && frame.direction == Direction::transmit))
        return Sentence{who, frame.jitter < Duration::zero()
                                 ? " has a jitter below 0: write how late its node may be"
                                 : " is sent and says a jitter, which follows from its activity: remove it"};
    return {};
}

template <std::size_t F, std::size_t S> constexpr Sentence map_fault(const SignalMap<F, S>& map) noexcept {
    for (std::size_t f = 0; f < F; ++f) {
        const FrameRow& row = map.frames[f];
        const Sentence who{"frame \"", row.name, "\""};
        if (row.name.empty()) return Sentence{"frame ", f + 1, " has no name: name it"};
        if (!valid(row.identifier))
            return Sentence{who, " has the identifier ", row.identifier.id,
                            ": a standard one ends at 2047, an extended one at 536870911"};
        if (row.length > 8)
            return Sentence{who, " has ", unsigned{row.length}, " bytes: a classic frame holds 8 at most"};
        for (std::size_t other = 0; other < f; ++other) {
            if (map.frames[other].name == row.name)
                return Sentence{who, " is there twice: rename one of them"};
            if (map.frames[other].identifier == row.identifier)
                return Sentence{who, " has the identifier of \"", map.frames[other].name,
                                "\": give it its own"};
        }
        std::array<std::size_t, 64> owner{};
        owner.fill(no_such);
        for (std::size_t s = row.first; s < row.first + row.signals; ++s) {
            if (const Sentence fault = signal_fault(row, map.signals[s]); !fault.empty()) return fault;
            if (const Sentence fault = safe_fault(row, map.signals[s]); !fault.empty()) return fault;
            for (std::size_t other = row.first; other < s; ++other)
                if (map.signals[other].name == map.signals[s].name)
                    return Sentence{who, " has two signals \"", map.signals[s].name,
                                    "\": rename one of them"};
            for (unsigned i = 0; i < map.signals[s].bits; ++i) {
                const unsigned place = bit_place(map.signals[s], i);
                if (owner[place] != no_such)
                    return Sentence{"signal \"",
                                    row.name,
                                    ".",
                                    map.signals[s].name,
                                    "\" overlaps \"",
                                    map.signals[owner[place]].name,
                                    "\" at bit ",
                                    place,
                                    ": move one of them"};
                owner[place] = s;
            }
        }
        if (const Sentence fault = rate_fault(row); !fault.empty()) return fault;
    }
    return {};
}

} // namespace detail

/// Flattens the rows and checks them: static_assert(map.fault.empty(), map.fault).
template <std::size_t... N> constexpr auto signal_map(const FrameWithSignals<N>&... rows) noexcept {
    SignalMap<sizeof...(N), (N + ... + 0)> map;
    std::size_t f = 0;
    std::size_t s = 0;
    const auto flatten = [&](const auto& row) {
        map.frames[f] = row.row;
        map.frames[f].first = s;
        for (const Signal& one : row.signals) {
            map.signals[s] = one;
            map.frame_of[s] = f;
            ++s;
        }
        if (row.row.direction == Direction::receive)
            map.received[map.received_count++] = row.row.identifier;
        else
            map.transmitted[map.transmitted_count++] = row.row.identifier;
        ++f;
    };
    (flatten(rows), ...);
    map.fault = detail::map_fault(map);
    for (const bool cyclic : {true, false})
        for (const FrameRow& row : map.frames) {
            if (!map.fault.empty() || row.direction == Direction::receive || row.silence_is_safe ||
                (row.every > Duration::zero()) != cyclic)
                continue;
            Frame& frame = map.safe[map.safe_count++];
            frame.id = row.identifier.id;
            frame.extended = row.identifier.extended;
            frame.length = row.length;
            for (const Signal& one : std::span{map.signals}.subspan(row.first, row.signals))
                insert(frame.data, one, to_raw(one, one.safe_value).bits);
        }
    return map;
}

} // namespace tappet::can

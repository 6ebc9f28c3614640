// The signals of a CAN bus as one constexpr table, checked by the compiler.
#pragma once

#include "drivers/can/frame.hpp"
#include "drivers/can/multiplexing.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"

#include <concepts>
#include <cstddef>
#include <span>

namespace tappet::can {

enum class Direction : std::uint8_t {
    receive,
    transmit,
    passing ///< frames between other nodes: only load on the bus, for the timing proof
};

/// How often a frame comes; the bus's response times are computed from this.
struct Rate {
    Duration every{};  ///< the period; 0: sent on demand, every one, in order
    Duration apart{};  ///< the least time between two frames; 0: the row does not say
    Duration jitter{}; ///< receive: how late its node may send it
};

/// A row of the table.
struct FrameRow : MapRow, Rate {
    Identifier identifier{};
    Direction direction = Direction::receive;
    std::uint8_t length = 0;
    Format format = Format::classical;
    bool multiplexed = false;   ///< a frame holds only some of its signals
    std::string_view in_file{}; ///< its name in its DBC file, when the row gives it another
    bool despite_file = false;  ///< its identifier or length is believed instead of its DBC file's
    bool despite_identifier = false;
    bool is_proven = false; ///< of another node whose own proof shows it is in time: only load here
};

/// Returns the row's frame without contents.
constexpr Frame frame_of(const FrameRow& row) noexcept TAPPET_REALTIME {
    Frame frame{.id = row.identifier.id, .extended = row.identifier.extended, .length = row.length};
    set_format(frame, row.format);
    return frame;
}

template <std::size_t N> using FrameWithSignals = RowWithValues<FrameRow, Signal, N>;

/// Identifier of a row, 11 bits: standard(0x181).
constexpr Identifier standard(std::uint32_t id) noexcept { return {id, false}; }
/// Identifier of a row, 29 bits: extended(0x18FF0102).
constexpr Identifier extended(std::uint32_t id) noexcept { return {id, true}; }

struct Bytes {
    std::uint8_t count = 0;
    Format format = Format::classical;

    /// CAN FD without the switch to the data bit rate.
    constexpr Bytes in_one_rate() const noexcept { return {count, Format::flexible}; }
};
/// Length of a classical frame, 8 bytes at most.
constexpr Bytes bytes(std::uint8_t count) noexcept { return {count, Format::classical}; }
/// Length of a CAN FD frame that switches to the data bit rate: 0 to 8, 12, 16, 20, 24, 32, 48 or 64 bytes.
/// Bits that no signal covers are sent as 0.
constexpr Bytes fd_bytes(std::uint8_t count) noexcept { return {count, Format::flexible_faster}; }
/// The frame has this period. A received frame may come later than that by `jitter`.
constexpr Rate every(Duration period, Duration jitter = {}) noexcept { return {period, period, jitter}; }
/// Sends the frame when one of its values was written: every one, in order. A received frame comes when its
/// node has something to send. The proof assumes `apart` between two frames; a breach by a sent frame is
/// counted.
constexpr Rate on_demand(Duration apart) noexcept { return {{}, apart, {}}; }

namespace detail {
template <class... Signals>
constexpr auto row(Identifier id, std::string_view name, Direction direction, Bytes length, Rate rate,
                   const Signals&... signals) noexcept {
    return FrameWithSignals<sizeof...(Signals)>{{{name}, rate, id, direction, length.count, length.format},
                                                {signals...}};
}
} // namespace detail

/// receive(standard(0x181), "main_drive", bytes(6), every(2ms), signal("statusword", 0, 16), ...)
/// The connection's row that reads a value states its maximum age.
template <class... Signals>
constexpr auto receive(Identifier id, std::string_view name, Bytes length, Rate rate,
                       const Signals&... signals) noexcept {
    return detail::row(id, name, Direction::receive, length, rate, signals...);
}
/// A row without a rate; the map's check then asks for one.
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
    return detail::row(id, name, Direction::transmit, length, rate, signals...);
}

/// The identifiers that one end of a bus receives and sends, and its safe frames.
struct Identifiers {
    std::span<const Identifier> receive{}, transmit{};
    bool has_fd = false;                ///< at least one of them is a CAN FD frame
    std::span<const Frame> safe{};      ///< see SignalMap::safe_frames
    std::span<const FrameRow> frames{}; ///< of a machine's end; read by tools
    std::span<const Signal> signals{};
    std::uint32_t restarts_allowed = 0; ///< of its controller; 0: the default of Settings
};

/// Most safe frames of all multiplexed frames of a map together, beyond one frame each.
inline constexpr std::size_t most_safe_pages = 16;

template <std::size_t F, std::size_t S> struct SignalMap {
    std::array<FrameRow, F> frames{};
    std::array<Signal, S> signals{};
    std::array<std::size_t, S> row_of{}; ///< the frame that holds a signal
    std::array<std::size_t, S> multiplexor_of{};
    std::array<Place, S> places{};
    std::array<Identifier, F> received{}; ///< the first `received_count` are valid
    std::array<Identifier, F> transmitted{};
    /// Frames that make the receivers safe after the machine's process has ended. The cyclic ones go first,
    /// because a receiver must have its command before a frame on demand changes its mode. A multiplexed
    /// frame has one for each page; the page that the multiplexor's safe value selects goes last.
    std::array<Frame, F + (S < most_safe_pages ? S : most_safe_pages)> safe{};
    std::size_t received_count = 0;
    std::size_t transmitted_count = 0;
    std::size_t safe_count = 0;
    Sentence fault{}; ///< empty when the table is correct

    /// Identifiers for Settings::receive and Settings::transmit; the map must outlive them.
    [[nodiscard]] constexpr std::span<const Identifier> receives() const noexcept {
        return std::span{received}.first(received_count);
    }
    [[nodiscard]] constexpr std::span<const Identifier> transmits() const noexcept {
        return std::span{transmitted}.first(transmitted_count);
    }
    [[nodiscard]] constexpr std::span<const Frame> safe_frames() const noexcept {
        return std::span{safe}.first(safe_count);
    }
    [[nodiscard]] constexpr Multiplexing multiplexing() const noexcept TAPPET_REALTIME {
        return {signals, multiplexor_of};
    }
    /// Returns whether a frame of the row holds the signal; raw_of(m) is the value of multiplexor m in it.
    template <class RawOf>
    [[nodiscard]] constexpr bool holds(const FrameRow& row, std::size_t s, const RawOf& raw_of) const noexcept
        TAPPET_REALTIME {
        return !row.multiplexed || multiplexing().holds(s, raw_of);
    }
    [[nodiscard]] constexpr std::size_t frame(Identifier id) const noexcept TAPPET_REALTIME {
        for (std::size_t f = 0; f < F; ++f)
            if (frames[f].identifier == id) return f;
        return no_such;
    }
    [[nodiscard]] constexpr std::size_t frame(std::string_view name) const noexcept {
        return index_of(name, F, [this](std::size_t f) { return MapName{{}, frames[f].name}; });
    }
    [[nodiscard]] constexpr MapName name_of(std::size_t s) const noexcept {
        return {frames[row_of[s]].name, signals[s].name};
    }
    /// Finds a signal by "frame.signal".
    [[nodiscard]] constexpr std::size_t signal(std::string_view path) const noexcept {
        return index_of(path, S, [this](std::size_t s) { return name_of(s); });
    }
};

namespace detail {

inline constexpr MapWords words{.row = "frame", .value = "signal", .comes = "received", .goes = "sent"};

/// A fault and its cure for a row that is written by hand. A row from a file has another cure.
struct LayoutFault {
    Sentence text{}, cure{};
};
/// A sentence with the row and the signal it is about; no_such: neither. Its cure may stand apart.
struct MapFault {
    Sentence text{}, cure{};
    std::size_t frame = no_such;
    std::size_t signal = no_such;
};

constexpr Sentence facet_fault(const FrameRow& frame) noexcept {
    if (frame.name.size() + 1 + std::string_view{"received"}.size() <= FacetName::most) return {};
    return Sentence{"frame \"", frame.name, "\": its name is too long for a facet's, which has at most ",
                    FacetName::most, " characters; give it a shorter one with .called(\"..\")"};
}
constexpr Sentence facet_fault(const FrameRow& frame, const Signal& s) noexcept {
    const Sentence who{"signal \"", frame.name, ".", s.name, "\""};
    if (frame.name.size() + 1 + s.name.size() > FacetName::most)
        return Sentence{who, ": a facet's name has at most ", FacetName::most,
                        " characters; give it or its frame a shorter one with .called(\"..\")"};
    if (s.name == "received" && frame.direction == Direction::receive)
        return Sentence{who, " has the name of the event that its frame arrived: rename it"};
    return {};
}
/// Checks the signal's place in its frame, and its range.
constexpr LayoutFault layout_fault(const FrameRow& frame, const Signal& s) noexcept {
    const Sentence who{"signal \"", frame.name, ".", s.name, "\""};
    if (s.bits == 0 || s.bits > 64)
        return {Sentence{who, " has ", unsigned{s.bits}, " bits"}, Sentence{": give it 1 to 64"}};
    const bool is_float = s.kind == Kind::float32 || s.kind == Kind::float64;
    if (is_float && s.bits != (s.kind == Kind::float64 ? 64 : 32))
        return {Sentence{who, " is a float of ", unsigned{s.bits}, " bits"}, Sentence{": give it 32 or 64"}};
    if (s.has_range && !(s.least <= s.most))
        return {Sentence{who, " has an empty range"}, Sentence{": put the lower bound first"}};
    const unsigned end = 8u * frame.length;
    const unsigned low = bit_place(s, 0);
    const unsigned high = bit_place(s, s.bits - 1u);
    if (s.start >= end || low >= end || high >= end)
        return {
            Sentence(who, " reaches outside its frame of ", unsigned{frame.length},
                     " bytes: it starts at bit ", unsigned{s.start},
                     s.order == Order::intel ? " (its lowest) and goes up " : " (its highest) and goes down ",
                     unsigned{s.bits}, " bits"),
            Sentence{"; move it or lengthen the frame"}};
    return {};
}
/// Checks the names of its values.
constexpr Sentence names_fault(const FrameRow& frame, const Signal& s) noexcept {
    if (s.names.empty()) return {};
    const Sentence who{"signal \"", frame.name, ".", s.name, "\""};
    const bool is_float = s.kind == Kind::float32 || s.kind == Kind::float64;
    for (std::size_t i = 0; i < s.names.size(); ++i) {
        const std::int64_t value = s.names[i].value;
        if (!is_float && to_integer(s, static_cast<std::uint64_t>(value) & mask_of(s)) != value)
            return Sentence(who, " has a name for the value ", value, ", which its ", unsigned{s.bits},
                            " bits cannot hold: correct one of them");
        for (std::size_t other = 0; other < i; ++other)
            if (s.names[other].value == value)
                return Sentence{who, " has two names for the value ", value, ": keep one"};
    }
    return {};
}

constexpr Sentence safe_fault(const FrameRow& frame, const Signal& s) noexcept {
    const bool is_sent = frame.direction != Direction::receive;
    Sentence no_name{};
    if (is_sent && !s.safe_name.empty()) no_name = name_fault(frame.name, s, s.safe_name);
    const Raw raw = to_raw(s, s.safe_value);
    const bool fits = !no_name.empty() || (!raw.saturated && !raw.refused);
    const Sentence fault = tappet::safe_fault(words, frame, s, is_sent, fits);
    return fault.empty() ? no_name : fault;
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

/// Checks the multiplexor of `s`. `before`: the signals of its frame ahead of it; the multiplexor must be
/// among them.
constexpr LayoutFault multiplexor_fault(const FrameRow& frame, const Signal& s,
                                        std::span<const Signal> before) noexcept {
    if (s.multiplexor.empty()) return {};
    const Sentence who{"signal \"", frame.name, ".", s.name, "\""};
    Nearest nearest{s.multiplexor};
    for (const Signal& each : before) {
        nearest.consider(each.name);
        if (each.name != s.multiplexor) continue;
        if (!is_integer(each) || each.bits > 32)
            return {Sentence("signal \"", frame.name, ".", each.name, "\" selects \"", s.name,
                             "\" but is not an integer of at most 32 bits"),
                    Sentence{": remove factor and offset"}};
        for (const Selection& values : s.selections) {
            if (values.from > values.to || values.to > mask_of(each))
                return {Sentence(who, " is selected by values that \"", each.name,
                                 "\" never has: ", values.from, " to ", values.to),
                        Sentence{"; correct them"}};
            // Its range limits only what is sent, and then another page would be sent.
            for (const std::uint32_t value : {values.from, values.to})
                if (const Raw raw = to_raw_integer(each, to_integer(each, value));
                    frame.direction == Direction::transmit && raw.bits != value)
                    return {Sentence(who, " is selected by the value ", value, ", which \"", each.name,
                                     "\" never has: its range lets ", raw.bits, " be sent instead"),
                            Sentence{"; widen its range(..), or correct the value"}};
        }
        return {};
    }
    return {
        Sentence{who, " is selected by \"", s.multiplexor, "\", which does not stand before it in its frame"},
        or_meant(nearest, "; write it there")};
}

constexpr LayoutFault length_fault(const FrameRow& frame) noexcept {
    const Sentence who{"frame \"", frame.name, "\" has ", unsigned{frame.length}, " bytes: "};
    if (frame.format == Format::classical) {
        if (frame.length <= 8) return {};
        return {Sentence{who, "a classical frame holds 8 at most"},
                Sentence{"; make it CAN FD by fd_bytes(..), in a DBC file by VFrameFormat"}};
    }
    const int padded = padded_length(frame.length);
    if (padded == frame.length) return {};
    if (padded < 0) return {Sentence{who, "a CAN FD frame holds 64 at most"}, Sentence{"; make it two"}};
    return {Sentence{who, "CAN FD has no such length"},
            Sentence{"; make it ", padded, ", and what no signal covers is padding"}};
}

/// The bits of a signal in its frame.
using Covered = std::array<std::uint64_t, sizeof(Payload) / 8>;
constexpr Covered covered_by(const Signal& s) noexcept {
    Covered covered{};
    for (unsigned i = 0; i < s.bits; ++i) {
        const unsigned bit = bit_place(s, i);
        covered[bit / 64u] |= std::uint64_t{1} << bit % 64u;
    }
    return covered;
}
/// Returns the first bit in both, or the bit behind the frame's `bytes`.
constexpr unsigned first_shared(const Covered& a, const Covered& b, unsigned bytes) noexcept {
    for (unsigned word = 0; 8u * word < bytes; ++word)
        if (const std::uint64_t shared = a[word] & b[word]; shared != 0)
            return 64u * word + static_cast<unsigned>(std::countr_zero(shared));
    return 8u * bytes;
}

template <std::size_t F, std::size_t S>
constexpr MapFault map_fault(const SignalMap<F, S>& map, std::size_t frames) noexcept {
    std::array<Covered, S> covered{}; // indexed by signal
    for (std::size_t f = 0; f < frames; ++f) {
        const FrameRow& row = map.frames[f];
        const Sentence who{"frame \"", row.name, "\""};
        if (row.name.empty()) return {Sentence{"frame ", f + 1, " has no name: name it"}, {}, f};
        if (const Sentence fault = facet_fault(row); !fault.empty()) return {fault, {}, f};
        if (!valid(row.identifier))
            return {Sentence{who, " has the identifier ", row.identifier.id,
                             ": a standard one ends at 2047, an extended one at 536870911"},
                    {},
                    f};
        if (const LayoutFault fault = length_fault(row); !fault.text.empty())
            return {fault.text, fault.cure, f};
        if (const Sentence fault = tappet::name_fault(words, map.frames, f); !fault.empty())
            return {fault, {}, f};
        if (const std::size_t other = map.frame(row.identifier); other < f)
            return {Sentence{who, " has the identifier of \"", map.frames[other].name, "\": give it its own"},
                    {},
                    f};
        for (std::size_t s = row.first; s < row.end(); ++s) {
            const Signal& signal = map.signals[s];
            const auto before = std::span{map.signals}.subspan(row.first, s - row.first);
            if (const Sentence fault = value_fault(words, row, map.signals, s); !fault.empty())
                return {fault, {}, f, s};
            if (const Sentence fault = facet_fault(row, signal); !fault.empty()) return {fault, {}, f, s};
            if (const LayoutFault fault = layout_fault(row, signal); !fault.text.empty())
                return {fault.text, fault.cure, f, s};
            if (const Sentence fault = names_fault(row, signal); !fault.empty()) return {fault, {}, f, s};
            if (const LayoutFault fault = multiplexor_fault(row, signal, before); !fault.text.empty())
                return {fault.text, fault.cure, f, s};
            if (const Sentence fault = safe_fault(row, signal); !fault.empty()) return {fault, {}, f, s};
            covered[s] = covered_by(signal);
            for (std::size_t other = row.first; other < s; ++other) {
                const unsigned shared = first_shared(covered[s], covered[other], row.length);
                if (shared < 8u * row.length && !map.multiplexing().exclude_each_other(s, other))
                    return {Sentence{"signal \"", row.name, ".", signal.name, "\" overlaps \"",
                                     map.signals[other].name, "\" at bit ", shared},
                            Sentence{": move one of them"}, f, s};
            }
        }
        if (const Sentence fault = rate_fault(row); !fault.empty()) return {fault, {}, f};
    }
    return {};
}

/// Returns the frame of safe values that holds the signal `wanted`; no_such: the page that the safe values
/// select.
template <std::size_t F, std::size_t S>
constexpr Frame safe_frame(const SignalMap<F, S>& map, const FrameRow& row, std::size_t wanted,
                           std::array<bool, S>& held) noexcept {
    std::array<std::uint64_t, S> raw{};
    for (std::size_t s = row.first; s < row.end(); ++s)
        raw[s] = to_raw(map.signals[s], map.signals[s].safe_value).bits;
    if (wanted != no_such)
        for (std::size_t at = wanted, up = map.multiplexor_of[at]; up != no_such;
             at = up, up = map.multiplexor_of[at])
            raw[up] = map.signals[at].selections[0].from;
    Frame frame = frame_of(row);
    for (std::size_t s = row.first; s < row.end(); ++s) {
        if (!map.holds(row, s, [&](std::size_t m) { return raw[m]; })) continue;
        insert(frame.data, map.places[s], raw[s]);
        held[s] = true;
    }
    return frame;
}

/// Returns false when there is no room for the row's pages.
template <std::size_t F, std::size_t S>
constexpr bool add_safe_frames(SignalMap<F, S>& map, const FrameRow& row, std::size_t& room) noexcept {
    std::array<bool, S> held{};
    const Frame last = safe_frame(map, row, no_such, held);
    for (std::size_t s = row.first; s < row.end(); ++s) {
        if (held[s]) continue;
        if (room-- == 0) return false;
        map.safe[map.safe_count++] = safe_frame(map, row, s, held);
    }
    map.safe[map.safe_count++] = last;
    return true;
}

/// Completes the map from its first `frames` rows and returns their first fault.
template <std::size_t F, std::size_t S>
constexpr MapFault complete(SignalMap<F, S>& map, std::size_t frames) noexcept {
    map.multiplexor_of.fill(no_such);
    for (std::size_t f = 0; f < frames; ++f) {
        FrameRow& row = map.frames[f];
        for (std::size_t s = row.first; s < row.end(); ++s) {
            map.row_of[s] = f;
            map.places[s] = place_of(map.signals[s]);
            Signal& one = map.signals[s];
            if (!one.safe_name.empty())
                if (const ValueName* const safe = value_called(one, one.safe_name); safe != nullptr)
                    one.safe_value = physical_of(one, *safe);
            row.multiplexed |= !map.signals[s].multiplexor.empty();
            for (std::size_t other = row.first; other < s; ++other)
                if (map.signals[other].name == map.signals[s].multiplexor) map.multiplexor_of[s] = other;
        }
        if (row.direction == Direction::receive)
            map.received[map.received_count++] = row.identifier;
        else
            map.transmitted[map.transmitted_count++] = row.identifier;
    }
    if (const MapFault fault = map_fault(map, frames); !fault.text.empty()) return fault;
    std::size_t room = map.safe.size() - F;
    for (const bool cyclic : {true, false})
        for (std::size_t f = 0; f < frames; ++f) {
            const FrameRow& row = map.frames[f];
            if (row.direction == Direction::receive || row.silence_is_safe ||
                (row.every > Duration::zero()) != cyclic)
                continue;
            if (!add_safe_frames(map, row, room))
                return {Sentence{"frame \"", row.name,
                                 "\" has too many pages, each of which must be sent to be "
                                 "safe: more than ",
                                 most_safe_pages,
                                 " beside the first ones of all frames; make "
                                 "its receiver safe by silence, .safe_by_silence()"},
                        {},
                        f};
        }
    return {};
}

} // namespace detail

/// Flattens the rows and checks them: static_assert(map.fault.empty(), map.fault).
template <std::size_t... N> constexpr auto signal_map(const FrameWithSignals<N>&... rows) noexcept {
    SignalMap<sizeof...(N), (N + ... + 0)> map;
    flatten(map.frames, map.signals, rows...);
    const detail::MapFault fault = detail::complete(map, map.frames.size());
    map.fault = Sentence{fault.text, fault.cure};
    return map;
}

} // namespace tappet::can

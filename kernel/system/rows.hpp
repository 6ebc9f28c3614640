// The system table (thesis 2.4, 1.2.2): several machines, the wire between them, and the rows that cross it,
// spelled like those inside a machine.
//
//     constexpr auto lane = system("woodworking-lane",
//         nodes(node<conveyor>("conveyor"), node<station>("saw"), node<station>("drill")),
//         wire("lane", bit_rate(500'000), beats(20ms), silent_after(70ms)),
//         crossings(
//             across(data("conveyor.belt.position", "saw.station.position", stale_after(80ms), hold),
//                    every(10ms), in_bits(24, 0.1)),
//             across(when("saw.station.board_out", tell("drill.station.board_in")), at_most(1, 100ms),
//                    within(20ms)),
//             across(uses("drill.station.hold", "conveyor.belt.hold"), at_most(1, 100ms), within(20ms)),
//             presence("saw", "drill.station.saw_is_there")),
//         promises(reaction("saw.station.board_out", "drill.station.board_in", within(30ms))));
//
// A path is "node.component.facet". No machine's own table refers to the system.
#pragma once

#include "kernel/machine/table/board.hpp"
#include "kernel/machine/table/machine.hpp"

#include <concepts>

namespace tappet {

/// One machine of the system. Several rows may use the same table.
struct SystemNode {
    std::string_view name{};
    MachineView table;
};

/// `table`: a constexpr machine(...) at namespace scope.
template <const auto& table>
constexpr SystemNode node(std::string_view name) {
    return {name, table.view()};
}

struct Beats {
    Duration every{};
};
/// The period of beats: each says that its node is alive, and names one of its rows and that row's layout.
constexpr Beats beats(Duration every) noexcept { return {every}; }
struct SilentAfter {
    Duration time{};
};
/// A node is lost when no beat of it arrived for this time: its rows end, and its presence is false.
constexpr SilentAfter silent_after(Duration time) noexcept { return {time}; }

/// How each node's activity serves the wire; the check of its own table proves it.
struct Service {
    Duration deadline = 1ms;
    Duration budget = 100us;
};
/// Serves an arrived frame, and sends waiting ones, within `deadline`; `budget` of each cycle.
constexpr Service served_within(Duration deadline, Budget each) noexcept { return {deadline, each.each}; }

struct Within {
    Duration time{};
};
/// The limit of a crossing: from writing, emission or sending until it was served at the other node.
constexpr Within within(Duration time) noexcept { return {time}; }

/// The node that tells the wire's common time, and how well the others must know it.
struct CommonClock {
    std::string_view node{};
    Duration every{};
    Duration within{};
    /// The longest time from the end of a frame to its stamp, at any node whose kernel stamps arrivals.
    Duration stamps_late = 100us;
    double drift = 210e-6; ///< maximum between two clocks, s/s
    int told = 0;          ///< how often the wire states it
};
struct StampsLate {
    Duration time{};
};
constexpr StampsLate stamps_late(Duration time) noexcept { return {time}; }
struct Drift {
    double most = 0;
};
/// The maximum drift between two nodes' clocks, s/s: crystals some 200e-6; a steering daemon adds its limit.
constexpr Drift drift(double most) noexcept { return {most}; }

/// bit/s of a wire, as bit_rate() states them.
struct WireRate {
    std::uint32_t bits_per_second = 0;
    std::uint32_t in_data_phase = 0; ///< of CAN FD frames that switch; 0: classical CAN only
};
/// The expected worst errors of a wire, as bus_errors() states them.
struct WireErrors {
    unsigned at_once = 1;
    Duration every = 100ms;
};

/// The wire between the nodes: classical CAN, or CAN FD when its bit rate has a second number.
struct WireRow {
    std::string_view name{}; ///< of the device in each node's binding, and of its component in each node
    WireRate rate{};
    WireErrors errors{};
    std::string_view foreign{}; ///< a word that does not apply to a wire, but to other devices
    Duration beats = 20ms;
    Duration silent_after = 70ms;
    Service service{};
    std::uint32_t first_identifier = 0x181;
    bool states_first = false;
    bool fixed_identifiers = false;
    CommonClock clock{};

    [[nodiscard]] constexpr bool is_fd() const noexcept { return rate.in_data_phase != 0; }
    [[nodiscard]] constexpr bool has_clock() const noexcept { return clock.told != 0; }
};

struct FirstIdentifier {
    std::uint32_t number = 0;
};
/// The wire's frames have identifiers of 11 bits from this one on: avoid those of other devices on it.
/// Default: they begin at the process data of CiA 301.
constexpr FirstIdentifier identifiers_from(std::uint32_t number) noexcept { return {number}; }

struct FixedIdentifiers {};
/// The wire's frames have identifiers of 29 bits, made only from each frame's identity and rate: no other row
/// changes them. So nodes of two versions of a system work together in all rows that both have, if new rows
/// are placed after the old ones. They cost 20 to 25 bits a frame. No other device on the wire may use 29
/// bits, and neither version proves the traffic that both bring to the wire together.
inline constexpr FixedIdentifiers fixed_identifiers{};

namespace detail {

constexpr void apply(CommonClock& clock, Within option) noexcept { clock.within = option.time; }
constexpr void apply(CommonClock& clock, StampsLate option) noexcept { clock.stamps_late = option.time; }
constexpr void apply(CommonClock& clock, Drift option) noexcept { clock.drift = option.most; }

constexpr void apply(WireRow& row, const CommonClock& option) noexcept {
    const int before = row.clock.told;
    row.clock = option;
    row.clock.told = before + 1;
}
constexpr void apply(WireRow& row, FixedIdentifiers) noexcept { row.fixed_identifiers = true; }
constexpr void apply(WireRow& row, FirstIdentifier option) noexcept {
    row.first_identifier = option.number;
    row.states_first = true;
}
/// Applies a word of the bus, as its driver declares it.
constexpr void apply(WireRow& row, const Fact& fact) noexcept {
    const auto& numbers = fact.numbers;
    if (fact.word->name == "bit_rate")
        row.rate = {static_cast<std::uint32_t>(numbers[0]), static_cast<std::uint32_t>(numbers[1])};
    else if (fact.word->name == "bus_errors")
        row.errors = {static_cast<unsigned>(numbers[0]), Duration{numbers[1]}};
    else
        row.foreign = fact.word->name;
}
constexpr void apply(WireRow& row, Beats option) noexcept { row.beats = option.every; }
constexpr void apply(WireRow& row, SilentAfter option) noexcept { row.silent_after = option.time; }
constexpr void apply(WireRow& row, Service option) noexcept { row.service = option; }

} // namespace detail

/// common_clock("conveyor", every(100ms), within(200us)): that node tells its time (AUTOSAR CanTSyn). The
/// others know it to within that error, or say that they do not: the compiler proves that they do while no
/// exchange is lost. The proof relies on stamps_late(...) and drift(...). The outputs `ahead`, `error` and
/// `known` of the component "<wire>_clock" show the time and its error.
template <class... Options>
constexpr CommonClock common_clock(std::string_view node, const TriggerOption& rate,
                                   const Options&... options) {
    CommonClock clock{.node = node, .every = rate.period};
    (detail::apply(clock, options), ...);
    return clock;
}

template <class... Options>
constexpr WireRow wire(std::string_view name, const Options&... options) {
    WireRow row{.name = name};
    (detail::apply(row, options), ...);
    return row;
}

/// The encoding of a number on the wire. Without it a value is sent as its own bytes, a bool as one bit.
struct Encoding {
    std::uint8_t bits = 0; ///< 0: the value's own bytes
    double step = 1;
    bool is_signed = true;
};
/// A whole number of `bits` bits, two's complement, times `step`: a value out of range is clamped and
/// counted. For a command it applies to its argument, and to a result that is one number.
constexpr Encoding in_bits(std::uint8_t bits, double step = 1) noexcept { return {bits, step, true}; }
/// Like in_bits(), but unsigned.
constexpr Encoding in_natural_bits(std::uint8_t bits, double step = 1) noexcept {
    return {bits, step, false};
}

struct IfLost {
    std::string_view operation{};
};
/// The operation that runs at an event's own node when no answer arrived within its time. Whether the event
/// was served is then unknown; a command that fails like this reports failed.
constexpr IfLost if_lost(std::string_view operation) noexcept { return {operation}; }

struct WithTime {};
/// Data: sends the common time at which the value was true, so that both nodes have the same stamp, to within
/// the common clock's bound of either node. The value is not valid while one of them does not know that time.
inline constexpr WithTime with_time{};

enum class CrossingKind : std::uint8_t { data, event, command, presence };

/// A row between two different nodes.
struct Crossing {
    CrossingKind kind = CrossingKind::data;
    ConnectionRow data{};   ///< of data and presence
    ReactionRow reaction{}; ///< of events and commands
    Duration every{};       ///< of data: the period of its frame
    std::int64_t at_most_n = 1;
    Duration at_most_per{}; ///< of events and commands: the shortest time between two
    Duration within{};      ///< 0: of data its period and the wire's time; the others must state it
    Encoding encoding{};
    bool with_time = false;
    std::string_view node{};    ///< of presence: the observed node
    std::string_view if_lost{}; ///< of an event: the operation of the emitter's node that is told

    [[nodiscard]] constexpr std::string_view from() const noexcept {
        return kind == CrossingKind::data ? data.from : reaction.event;
    }
    [[nodiscard]] constexpr std::string_view to() const noexcept {
        return kind == CrossingKind::data || kind == CrossingKind::presence ? data.to
                                                                            : reaction.target.operation;
    }
};

namespace detail {

constexpr void apply(Crossing& row, const TriggerOption& option) noexcept { row.every = option.period; }
constexpr void apply(Crossing& row, AtMost option) noexcept {
    row.at_most_n = option.n;
    row.at_most_per = option.per;
}
constexpr void apply(Crossing& row, Within option) noexcept { row.within = option.time; }
constexpr void apply(Crossing& row, Encoding option) noexcept { row.encoding = option; }
constexpr void apply(Crossing& row, WithTime) noexcept { row.with_time = true; }
constexpr void apply(Crossing& row, IfLost option) noexcept { row.if_lost = option.operation; }

} // namespace detail

/// data("a.x.y", "b.x.y", ...), every(10ms), and its encoding.
template <class... Options>
constexpr Crossing across(const ConnectionRow& row, const Options&... options) {
    Crossing crossing{.kind = CrossingKind::data, .data = row};
    (detail::apply(crossing, options), ...);
    return crossing;
}
/// when("a.x.event", tell("b.x.operation")) or uses("a.x.call", "b.x.command"), at_most(1, 100ms),
/// within(20ms). Served at most once, in order; both ends know every loss.
template <class... Options>
constexpr Crossing across(const ReactionRow& row, const Options&... options) {
    Crossing crossing{.kind = row.kind == ReactionKind::uses ? CrossingKind::command : CrossingKind::event,
                      .reaction = row};
    (detail::apply(crossing, options), ...);
    return crossing;
}
/// Whether that node is heard, for an input of type bool; options like those of data(...).
template <class... Options>
constexpr Crossing presence(std::string_view node, std::string_view input, const Options&... options) {
    Crossing crossing{.kind = CrossingKind::presence, .node = node};
    crossing.data.to = input;
    (detail::apply(crossing.data, options), ...);
    return crossing;
}

/// A promise that the compiler must prove for the whole system.
struct PromiseRow {
    bool stops = false;      ///< a stop time; otherwise a reaction
    std::string_view from{}; ///< of a reaction: the event, or the output
    std::string_view to{};   ///< of a reaction: the operation, or the input
    std::string_view node{}; ///< of a stop time: the node that becomes silent
    Duration within{};
    Bounded<std::string_view, 8> via{}; ///< in pairs: an input of a component, and its reaction
    bool too_many = false;
};

struct Via {
    std::string_view in{}, out{};
};
/// A component in the chain: the operation or input by which it hears, and the event or output that follows
/// in the same cycle of the component.
constexpr Via via(std::string_view in, std::string_view out) noexcept { return {in, out}; }

namespace detail {

constexpr void apply(PromiseRow& row, Within option) noexcept { row.within = option.time; }
constexpr void apply(PromiseRow& row, Via option) noexcept {
    row.too_many |= !row.via.push(option.in) || !row.via.push(option.out);
}

} // namespace detail

/// reaction("saw.station.out", "drill.station.start", within(50ms), via("belt.in", "belt.out")): proven, or
/// refused with the largest part of its time.
template <class... Options>
constexpr PromiseRow reaction(std::string_view from, std::string_view to, const Options&... options) {
    PromiseRow row{.from = from, .to = to};
    (detail::apply(row, options), ...);
    return row;
}
/// stops("saw", "conveyor.belt.saw_is_there", within(120ms)): within this time after the saw's last sign of
/// life the input has its stale value, or shows that the saw is gone.
constexpr PromiseRow stops(std::string_view node, std::string_view input, Within limit) {
    return {.stops = true, .to = input, .node = node, .within = limit.time};
}

/// A system as spans.
struct SystemView {
    std::string_view name{};
    std::span<const SystemNode> nodes;
    WireRow wire{};
    std::span<const Crossing> crossings;
    std::span<const PromiseRow> promises;
};

template <std::size_t Nodes, std::size_t Crossings, std::size_t Promises>
struct System {
    std::string_view name{};
    std::array<SystemNode, Nodes> nodes{};
    WireRow wire{};
    std::array<Crossing, Crossings> crossings{};
    std::array<PromiseRow, Promises> promises{};

    [[nodiscard]] constexpr SystemView view() const noexcept {
        return {name, nodes, wire, crossings, promises};
    }
};

// For rows only: a slot of a machine has its own nodes(32).
template <std::same_as<SystemNode>... Rows>
constexpr Section<SystemNode, sizeof...(Rows)> nodes(const Rows&... rows) {
    return {{rows...}};
}
template <std::same_as<Crossing>... Rows>
constexpr Section<Crossing, sizeof...(Rows)> crossings(const Rows&... rows) {
    return {{rows...}};
}
template <std::same_as<PromiseRow>... Rows>
constexpr Section<PromiseRow, sizeof...(Rows)> promises(const Rows&... rows) {
    return {{rows...}};
}

template <std::size_t N, std::size_t X, std::size_t P = 0>
constexpr System<N, X, P> system(std::string_view name, const Section<SystemNode, N>& nodes,
                                 const WireRow& wire, const Section<Crossing, X>& crossings,
                                 const Section<PromiseRow, P>& promises = {}) {
    return {name, nodes.rows, wire, crossings.rows, promises.rows};
}

} // namespace tappet

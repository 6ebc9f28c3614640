// The system table (thesis 2.4, 1.2.2): several machines, the wire between them, and what crosses it, spelled
// as inside a machine.
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
// A path is "node.component.facet". No machine's own table knows of it.
#pragma once

#include "kernel/machine/table/board.hpp"
#include "kernel/machine/table/machine.hpp"

#include <concepts>

namespace tappet {

/// One machine of the system. The same table may stand in several rows.
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
/// Each node says so often that it is there, which row it is about to tell, and what that row looks like.
constexpr Beats beats(Duration every) noexcept { return {every}; }
struct SilentAfter {
    Duration time{};
};
/// A node of which no beat came for so long is lost: its rows end, and its presence is false.
constexpr SilentAfter silent_after(Duration time) noexcept { return {time}; }

/// How each node's activity serves the wire, which its own table's check then proves.
struct Service {
    Duration deadline = 1ms;
    Duration budget = 100us;
};
/// Within `deadline` of a frame's arrival it is served, and so is what is to be sent; `budget` of each cycle.
constexpr Service served_within(Duration deadline, Budget each) noexcept { return {deadline, each.each}; }

struct Within {
    Duration time{};
};
/// Of a crossing: from the writing, the emission or the sending until it was served at the other node.
constexpr Within within(Duration time) noexcept { return {time}; }

/// Who tells the wire's common time, and how well the others are to know it.
struct CommonClock {
    std::string_view node{};
    Duration every{};
    Duration within{};
    /// From the end of a frame to its stamp at most, at any node: of a kernel that stamps what arrives.
    Duration stamps_late = 100us;
    double drift = 210e-6; ///< of two clocks against each other at most, s in a s
    int told = 0;          ///< how often the wire says it
};
struct StampsLate {
    Duration time{};
};
constexpr StampsLate stamps_late(Duration time) noexcept { return {time}; }
struct Drift {
    double most = 0;
};
/// By how much two nodes' clocks may part, s in a s: of crystals some 200e-6; a daemon that steers them adds
/// what it may.
constexpr Drift drift(double most) noexcept { return {most}; }

/// bit/s of a wire, as bit_rate() says them.
struct WireRate {
    std::uint32_t bits_per_second = 0;
    std::uint32_t in_data_phase = 0; ///< of CAN FD frames that switch; 0: classical CAN only
};
/// What is to be expected of a wire at its worst, as bus_errors() says it.
struct WireErrors {
    unsigned at_once = 1;
    Duration every = 100ms;
};

/// The wire between the nodes: classical CAN, or CAN FD where its bit rate has a second number.
struct WireRow {
    std::string_view name{}; ///< of the device in each node's binding, and of what stands on it there
    WireRate rate{};
    WireErrors errors{};
    std::string_view foreign{}; ///< a word that is said of it and for other devices
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
/// The wire's frames have the identifiers from this one on, of 11 bits: clear of whatever else is on it.
/// Unless stated they begin where CiA 301 has its process data.
constexpr FirstIdentifier identifiers_from(std::uint32_t number) noexcept { return {number}; }

struct FixedIdentifiers {};
/// The wire's frames have identifiers of 29 bits, made of what each frame is and how often it comes alone: no
/// other row moves them, so that nodes of two versions of a system work together in all rows that both have,
/// if new rows stand behind the old ones. They cost 20 to 25 bits a frame. Nothing else of 29 bits may be on
/// the wire, and what two versions bring to it together is proven by neither.
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
/// In the words of the bus that it is, which its driver declares.
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

/// common_clock("conveyor", every(100ms), within(200us)): that node tells its time (AUTOSAR CanTSyn), and the
/// others know it to within so much, or say that they do not: the compiler proves that they do while no
/// exchange is lost. That rests on stamps_late(...) and drift(...), which are believed. What they know, and
/// how surely, is told by the outputs `ahead`, `error` and `known` of the component "<wire>_clock".
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

/// How a number is told on the wire. Without it a value goes as the bytes that it is, a bool as one bit.
struct Encoding {
    std::uint8_t bits = 0; ///< 0: as it is
    double step = 1;
    bool is_signed = true;
};
/// A whole number of so many bits, two's complement, times `step`: what is beyond that is told as the last
/// one that fits, and counted. Of a command its argument, and a result that is one number.
constexpr Encoding in_bits(std::uint8_t bits, double step = 1) noexcept { return {bits, step, true}; }
/// Likewise, from nought up.
constexpr Encoding in_natural_bits(std::uint8_t bits, double step = 1) noexcept {
    return {bits, step, false};
}

struct IfLost {
    std::string_view operation{};
};
/// Of an event: what runs at its own node when nobody has answered within its time. Whether it was served is
/// then not known; a command that fails so says failed.
constexpr IfLost if_lost(std::string_view operation) noexcept { return {operation}; }

struct WithTime {};
/// Of data: it crosses with the common time at which it was true, so that its stamp there is what it was
/// here, to within the common clock's bound of either node; while one of the two does not know that time it
/// is not valid.
inline constexpr WithTime with_time{};

enum class CrossingKind : std::uint8_t { data, event, command, presence };

/// A row whose two ends are in different nodes.
struct Crossing {
    CrossingKind kind = CrossingKind::data;
    ConnectionRow data{};   ///< of data and presence
    ReactionRow reaction{}; ///< of events and commands
    Duration every{};       ///< of data: the period of its frame
    std::int64_t at_most_n = 1;
    Duration at_most_per{}; ///< of events and commands: the least time between two
    Duration within{};      ///< 0: of data its period and what the wire takes; of the others it must be said
    Encoding encoding{};
    bool with_time = false;
    std::string_view node{};    ///< of presence: whose
    std::string_view if_lost{}; ///< of an event: the operation of the emitter's node that hears of it

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

/// data("a.x.y", "b.x.y", ...), every(10ms), and what it is told in.
template <class... Options>
constexpr Crossing across(const ConnectionRow& row, const Options&... options) {
    Crossing crossing{.kind = CrossingKind::data, .data = row};
    (detail::apply(crossing, options), ...);
    return crossing;
}
/// when("a.x.event", tell("b.x.operation")) or uses("a.x.call", "b.x.command"), at_most(1, 100ms),
/// within(20ms). Never twice, in order; what is lost is known at both ends.
template <class... Options>
constexpr Crossing across(const ReactionRow& row, const Options&... options) {
    Crossing crossing{.kind = row.kind == ReactionKind::uses ? CrossingKind::command : CrossingKind::event,
                      .reaction = row};
    (detail::apply(crossing, options), ...);
    return crossing;
}
/// Whether that node is heard, for an input of type bool; options as of data(...).
template <class... Options>
constexpr Crossing presence(std::string_view node, std::string_view input, const Options&... options) {
    Crossing crossing{.kind = CrossingKind::presence, .node = node};
    crossing.data.to = input;
    (detail::apply(crossing.data, options), ...);
    return crossing;
}

/// What the compiler is to prove of the whole.
struct PromiseRow {
    bool stops = false;      ///< a stop time; otherwise a reaction
    std::string_view from{}; ///< of a reaction: the event, or the output
    std::string_view to{};   ///< of a reaction: the operation, or the input
    std::string_view node{}; ///< of a stop time: who falls silent
    Duration within{};
    Bounded<std::string_view, 8> via{}; ///< in pairs: what came in at a component, and what that emits then
    bool too_many = false;
};

struct Via {
    std::string_view in{}, out{};
};
/// A component on the way: the operation or input by which it hears, and the event or output that follows in
/// the same cycle of it.
constexpr Via via(std::string_view in, std::string_view out) noexcept { return {in, out}; }

namespace detail {

constexpr void apply(PromiseRow& row, Within option) noexcept { row.within = option.time; }
constexpr void apply(PromiseRow& row, Via option) noexcept {
    row.too_many |= !row.via.push(option.in) || !row.via.push(option.out);
}

} // namespace detail

/// reaction("saw.station.out", "drill.station.start", within(50ms), via("belt.in", "belt.out")): proven, or
/// refused with the largest part of it.
template <class... Options>
constexpr PromiseRow reaction(std::string_view from, std::string_view to, const Options&... options) {
    PromiseRow row{.from = from, .to = to};
    (detail::apply(row, options), ...);
    return row;
}
/// stops("saw", "conveyor.belt.saw_is_there", within(120ms)): so long after the saw's last sign of life the
/// input there has its stale value, or says that it is gone.
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

// Of rows only: a slot of a machine has its nodes(32), too.
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

// The plan that the compiler derives from a system table: the frames on the wire, their contents and
// priorities; how each row differs from another version's; and whether every promise holds.
#pragma once

#include "kernel/system/identifiers.hpp"

namespace tappet {

namespace systems {

constexpr void add_value(Digest& digest, const WireValue& value) noexcept {
    digest.add(std::uint64_t{value.bits});
    digest.add(static_cast<std::uint64_t>(value.kind));
    digest.add(std::uint64_t{value.is_signed ? 1u : 0u} | std::uint64_t{value.has_time ? 2u : 0u});
    digest.add(std::bit_cast<std::uint64_t>(value.step));
}

/// Adds the layout of a value that crosses as its own bytes. A type without named fields adds only its size.
constexpr void add_type(Digest& digest, TypeId type) noexcept {
    if (type == nullptr) return;
    digest.add(static_cast<std::uint64_t>(type->kind));
    digest.add(std::uint64_t{type->size} | std::uint64_t{type->rows} << 16 |
               std::uint64_t{type->columns} << 32 | std::uint64_t{type->row_major ? 1u : 0u} << 48);
    add_type(digest, type->element);
    for (const TypeId each : type->elements) add_type(digest, each);
    for (const std::string_view each : type->names) add_text(digest, each);
    for (const RecordField& each : type->fields) {
        add_text(digest, each.name);
        add_text(digest, each.unit);
        add_type(digest, each.type);
    }
}

/// Returns the time from the arrival of a value or a message until the component has seen it: a periodic
/// activity waits for its next period in any case.
constexpr Duration read_within(const SystemView& s, const NodeEnd& end) {
    const MachineView& table = s.nodes[end.node].table;
    const std::size_t a = activity_of(table, table.components[end.at.component].name);
    if (a == nowhere) return {};
    const ActivityRow& row = table.activities[a];
    return row.deadline() + (row.periodic() ? row.period : Duration{});
}

/// Returns the part of a row's time that is not its frame on the wire.
constexpr Duration around_wire(const SystemView& s, const Crossing& row, const CrossingIndex& index) {
    const Duration served = s.wire.service.deadline;
    return row.kind == CrossingKind::data ? row.every + served : served + read_within(s, index.to);
}

template <std::size_t N, std::size_t X>
constexpr std::size_t add_frame(SystemPlan<N, X>& plan, const WireFrame& frame) {
    static_cast<void>(plan.frames.push(frame));
    return plan.frames.size() - 1;
}

/// Packs values into frames. Values of one node and one period share frames; each goes into the first frame
/// with room. The widest come first, or with fixed identifiers the order of the rows, so that a new row at
/// the end moves no earlier one.
template <std::size_t N, std::size_t X>
constexpr Sentence pack_data(const SystemView& s, SystemPlan<N, X>& plan) {
    std::array<std::size_t, X> by_width{};
    std::size_t count = 0;
    for (std::size_t x = 0; x < X; ++x)
        if (s.crossings[x].kind == CrossingKind::data) by_width[count++] = x;
    std::sort(by_width.begin(), by_width.begin() + static_cast<std::ptrdiff_t>(count),
              [&](std::size_t a, std::size_t b) {
                  return !s.wire.fixed_identifiers && plan.index[a].value.bits != plan.index[b].value.bits
                             ? plan.index[a].value.bits > plan.index[b].value.bits
                             : a < b;
              });
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t x = by_width[i];
        const Crossing& row = s.crossings[x];
        const std::uint16_t bits = plan.index[x].value.bits_in_frame();
        if (plan.shape.protection_bits + bits > plan.shape.most_bits)
            return of_crossing(
                row, ": its value takes ", unsigned{bits}, " bits with its validity bit",
                row.with_time ? " and the time" : "", ", but a frame has ",
                plan.shape.most_bits - plan.shape.protection_bits,
                " for values; send fewer: in_bits(32, 0.001) of a number, or a part of a record");
        CrossingPlace& place = plan.place[x];
        for (std::size_t before = 0; before < i && place.frame == nowhere; ++before) {
            const std::size_t b = by_width[before]; // the same value, for another reader
            if (s.crossings[b].data.from != row.data.from) continue;
            if (s.crossings[b].every != row.every || plan.index[b].value != plan.index[x].value)
                return of_crossing(row, " is sent differently from the row to \"", s.crossings[b].to(),
                                   "\"; give all rows of one output the same every(...) and the same bits");
            place = plan.place[b];
        }
        const Duration left =
            row.within == Duration::zero() ? row.every : row.within - around_wire(s, row, plan.index[x]);
        if (left <= Duration::zero())
            return of_crossing(row, " must arrive within ", row.within.count() / 1000, " us, but ",
                               around_wire(s, row, plan.index[x]).count() / 1000,
                               " us of that are its every(...) and the deadline by which the wire is served; "
                               "shorten those, or write a longer within(...)");
        if (place.frame != nowhere) {
            plan.frames[place.frame].deadline = std::min(plan.frames[place.frame].deadline, left);
            continue;
        }
        for (std::size_t f = 0; f < plan.frames.size() && place.frame == nowhere; ++f) {
            const WireFrame& frame = plan.frames[f];
            if (frame.kind == WireFrameKind::data && frame.node == plan.index[x].from.node &&
                frame.apart == row.every && frame.bits + bits <= plan.shape.most_bits)
                place.frame = f;
        }
        if (place.frame == nowhere)
            place.frame = add_frame(plan, {.node = plan.index[x].from.node,
                                           .kind = WireFrameKind::data,
                                           .crossing = x,
                                           .apart = row.every,
                                           .deadline = row.every,
                                           .bits = plan.shape.protection_bits});
        WireFrame& frame = plan.frames[place.frame];
        place.at = frame.bits;
        frame.bits = static_cast<std::uint16_t>(frame.bits + bits);
        frame.deadline = std::min(frame.deadline, left);
    }
    return {};
}

template <std::size_t N, std::size_t X>
constexpr Sentence add_channels(const SystemView& s, SystemPlan<N, X>& plan, std::size_t x) {
    const Crossing& row = s.crossings[x];
    const CrossingIndex& index = plan.index[x];
    const Duration left = row.within - around_wire(s, row, index);
    if (left <= Duration::zero())
        return of_crossing(
            row, " must be served within ", row.within.count() / 1000, " us, but ",
            around_wire(s, row, index).count() / 1000,
            " us of that are the deadlines of the activities that serve the wire and the operation; "
            "shorten those, or write a longer within(...)");
    const Duration again = row.within / 2;
    const std::size_t channel_bits = plan.shape.channel_bits(), most_wire_bits = plan.shape.most_bits;
    const auto frame = [&](std::size_t node, WireFrameKind kind, std::size_t bits) {
        return WireFrame{.node = node,
                         .kind = kind,
                         .crossing = x,
                         .apart = again,
                         // A message and its answer, at their worst, are sent before it is given up.
                         .deadline = std::min(left, again - s.wire.service.deadline),
                         .bits = static_cast<std::uint16_t>(bits)};
    };
    if (channel_bits + index.value.bits > most_wire_bits)
        return of_crossing(row, ": its arguments take ", unsigned{index.value.bits},
                           " bits, and a frame has ", most_wire_bits - channel_bits,
                           " for them; send numbers with in_bits(...), or the rest by data(...)");
    plan.place[x].frame =
        add_frame(plan, frame(index.from.node, WireFrameKind::message, channel_bits + index.value.bits));
    plan.place[x].answer = add_frame(plan, frame(index.to.node, WireFrameKind::answer, channel_bits + 8));
    if (row.kind != CrossingKind::command) return {};
    if (channel_bits + 8 + index.result.bits > most_wire_bits)
        return of_crossing(row, ": its results take ", unsigned{index.result.bits}, " bits, and a frame has ",
                           most_wire_bits - channel_bits - 8, " for them; send them by data(...)");
    plan.place[x].reply =
        add_frame(plan, frame(index.to.node, WireFrameKind::reply, channel_bits + 8 + index.result.bits));
    plan.place[x].received =
        add_frame(plan, frame(index.from.node, WireFrameKind::received, channel_bits + 8));
    return {};
}

/// Adds the clock's two frames before all frames of rows: they are few, and its precision depends on them.
template <std::size_t N, std::size_t X>
constexpr void add_clock(const SystemView& s, SystemPlan<N, X>& plan) {
    const Duration quarter = s.wire.clock.every / 4; // see can::follow_up_within
    WireFrame frame{.node = find_node(s, s.wire.clock.node),
                    .kind = WireFrameKind::sync,
                    .apart = s.wire.clock.every,
                    .deadline = quarter,
                    .bits = 64};
    add_frame(plan, frame);
    frame.kind = WireFrameKind::follow_up;
    frame.apart -= quarter;
    add_frame(plan, frame);
}

/// Checks the clock's error: the clocks drift apart from the last valid exchange until the next one.
constexpr Sentence check_clock_error(const SystemView& s, std::span<const WireFrame> frames,
                                     Duration& error) {
    const CommonClock& clock = s.wire.clock;
    Duration age = clock.every + 2 * s.wire.service.deadline + clock.stamps_late;
    for (const WireFrame& frame : frames)
        if (frame.is_of_clock()) age += frame.worst;
    // Includes the rounding up for each frame that wakes a node with the clock.
    const Duration parted{static_cast<std::int64_t>(static_cast<double>(age.count()) * clock.drift) + 1 +
                          age.count() / 50'000};
    error = clock.stamps_late + parted;
    if (error <= clock.within) return {};
    return Sentence{
        "common_clock(\"",
        clock.node,
        "\"): its error may be ",
        error.count() / 1000,
        " us, but it is promised within ",
        clock.within.count() / 1000,
        " us; the larger part, ",
        std::max(clock.stamps_late, parted).count() / 1000,
        " us, is ",
        clock.stamps_late >= parted
            ? Sentence{"how late frames are stamped; write a shorter stamps_late(...) if that is true"}
            : Sentence{"the drift of the clocks in ", age.count() / 1'000'000, " ms; send it more often"},
        ", or promise less"};
}

template <std::size_t N, std::size_t X>
constexpr Sentence resolve_crossings(const SystemView& s, SystemPlan<N, X>& plan) {
    for (std::size_t x = 0; x < X; ++x) {
        const Crossing& row = s.crossings[x];
        if (Sentence fault = resolve_crossing(s, row, plan.index[x]); !fault.empty()) return fault;
        Digest name;
        add_text(name, row.kind == CrossingKind::presence ? row.node : row.from());
        add_text(name, row.to());
        plan.index[x].name = folded(name);
        for (std::size_t other = 0; other < x; ++other)
            if (row.kind != CrossingKind::presence && plan.index[other].name == plan.index[x].name)
                return of_crossing(row, " has the same number as \"", s.crossings[other].from(), "\" -> \"",
                                   s.crossings[other].to(),
                                   "\", or appears twice; remove it, or rename a node");
    }
    return {};
}

/// Adds all frames of the wire.
template <std::size_t N, std::size_t X>
constexpr Sentence add_frames(const SystemView& s, SystemPlan<N, X>& plan) {
    for (std::size_t n = 0; n < N; ++n)
        add_frame(plan, {.node = n,
                         .kind = WireFrameKind::beat,
                         .apart = s.wire.beats,
                         .deadline = s.wire.beats,
                         .bits = plan.shape.beat_bits()});
    if (s.wire.has_clock()) add_clock(s, plan);
    if (Sentence fault = pack_data(s, plan); !fault.empty()) return fault;
    for (std::size_t x = 0; x < X; ++x) {
        const CrossingKind kind = s.crossings[x].kind;
        if (kind != CrossingKind::event && kind != CrossingKind::command) continue;
        if (Sentence fault = add_channels(s, plan, x); !fault.empty()) return fault;
    }
    if (plan.frames.size() > most_traffic_rows)
        return Sentence{"wire \"",
                        s.wire.name,
                        "\" has ",
                        plan.frames.size(),
                        " frames, more than ",
                        most_traffic_rows,
                        " that are analysed: send the values of a node with one every(...), send rare events "
                        "as values, or make two systems"};
    return {};
}

/// Numbers the frames; returns the first late one, in the order of priority, or the number of frames.
template <std::size_t N, std::size_t X>
constexpr std::size_t number_frames(const SystemView& s, SystemPlan<N, X>& plan, WireAnalysis analysis) {
    for (std::size_t f = 0; f < plan.frames.size(); ++f) {
        const Digest key = key_of(s, plan, f);
        plan.frames[f].data_id = folded(key);
        plan.frames[f].id = fixed_identifier(plan.frames[f], key.value());
    }
    const std::size_t bad = assign(s, plan, analysis);
    for (std::size_t f = 0; f < plan.frames.size() && !s.wire.fixed_identifiers; ++f) {
        const bool is_second = plan.frames[f].kind == WireFrameKind::follow_up;
        plan.frames[f].id = s.wire.first_identifier + static_cast<std::uint32_t>(f - (is_second ? 1 : 0));
    }
    return bad;
}

/// Computes the layout digest by which a row is distinguished from another version's.
template <std::size_t N, std::size_t X>
constexpr void name_layouts(const SystemView& s, SystemPlan<N, X>& plan) {
    for (std::size_t x = 0; x < X; ++x) {
        const Crossing& row = s.crossings[x];
        const CrossingPlace& place = plan.place[x];
        CrossingIndex& index = plan.index[x];
        Digest layout;
        layout.add(static_cast<std::uint64_t>(row.kind));
        add_value(layout, index.value);
        add_value(layout, index.result);
        if (index.from.facet != nullptr) add_text(layout, index.from.facet->unit);
        if (index.from.facet != nullptr && index.value.kind == ValueKind::opaque)
            add_type(layout, index.from.facet->type);
        if (row.kind == CrossingKind::command) add_type(layout, index.to.facet->command->results);
        if (row.with_time) {
            const CommonClock& clock = s.wire.clock;
            add_text(layout, clock.node);
            for (const Duration each : {clock.every, clock.within, clock.stamps_late})
                layout.add(static_cast<std::uint64_t>(each.count()));
            layout.add(std::bit_cast<std::uint64_t>(clock.drift));
        }
        layout.add(std::uint64_t{place.at});
        for (const std::size_t f : {place.frame, place.answer, place.reply, place.received})
            if (f != nowhere) layout.add(std::uint64_t{plan.frames[f].id});
        layout.add(static_cast<std::uint64_t>(row.every.count()));
        layout.add(static_cast<std::uint64_t>(row.within.count()));
        index.layout = folded(layout);
    }
}

template <std::size_t N, std::size_t X>
constexpr Sentence check_frames(const SystemView& s, const SystemPlan<N, X>& plan, bool in_time) {
    for (const WireFrame& frame : plan.frames) {
        if (!in_time || frame.kind != WireFrameKind::beat) continue;
        const Duration needed = 2 * s.wire.beats + frame.worst + s.wire.service.deadline;
        if (s.wire.silent_after < needed)
            return Sentence{"wire \"", s.wire.name,
                            "\": a node must survive one lost beat, and the next one may then come after ",
                            needed.count() / 1000, " us; write silent_after(...) of more than that"};
    }
    if (!s.wire.fixed_identifiers && s.wire.first_identifier + plan.frames.size() > 0x800)
        return Sentence{"wire \"",
                        s.wire.name,
                        "\": ",
                        plan.frames.size(),
                        " frames from identifier ",
                        s.wire.first_identifier,
                        " on go beyond the last of 11 bits; begin lower"};
    for (std::size_t f = 1; f < plan.frames.size(); ++f)
        if (plan.frames[f].id == plan.frames[f - 1].id &&
            !(plan.frames[f].is_of_clock() && plan.frames[f - 1].is_of_clock()))
            return Sentence{"wire \"",
                            s.wire.name,
                            "\": two frames of node \"",
                            s.nodes[plan.frames[f].node].name,
                            "\" and node \"",
                            s.nodes[plan.frames[f - 1].node].name,
                            "\" would have the same fixed identifier; rename one of the nodes"};
    return {};
}

template <std::size_t N, std::size_t X>
constexpr Sentence late_fault(const SystemView& s, const SystemPlan<N, X>& plan, std::size_t bad) {
    const WireFrame& frame = plan.frames[bad];
    const Sentence what = frame.crossing == nowhere ? Sentence{frame.is_of_clock() ? "the clock" : "the beat",
                                                               " of node \"", s.nodes[frame.node].name, "\""}
                                                    : of_crossing(s.crossings[frame.crossing]);
    std::int64_t load_ppm = 0;
    for (const WireFrame& each : plan.frames)
        load_ppm += each.on_wire.count() * 1'000'000 / each.apart.count();
    constexpr std::string_view cure = "; send less, or less often, run the wire faster, or give it more time";
    if (load_ppm >= 1'000'000)
        return Sentence{what,
                        ": a frame of it may never be sent on wire \"",
                        s.wire.name,
                        "\", which all frames together load by ",
                        load_ppm / 10'000,
                        " % at ",
                        s.wire.rate.bits_per_second,
                        " bit/s; send less, or less often, or run the wire faster"};
    if (frame.worst == Duration::max())
        return Sentence{what,
                        ": a frame of it may still wait for wire \"",
                        s.wire.name,
                        "\" when the next one follows, ",
                        frame.apart.count() / 1000,
                        " us later",
                        cure};
    return Sentence{what,
                    ": a frame of it may take ",
                    frame.worst.count() / 1000,
                    " us on wire \"",
                    s.wire.name,
                    "\" and has ",
                    frame.deadline.count() / 1000,
                    " us",
                    cure};
}

} // namespace systems

/// Plans a system.
template <std::size_t N, std::size_t X, std::size_t P>
constexpr SystemPlan<N, X> plan_system(const System<N, X, P>& table, WireAnalysis analysis) {
    SystemPlan<N, X> plan;
    const SystemView s = table.view();
    plan.shape = shape_of(s.wire);
    const auto refuse = [&](const Sentence& fault) { plan.fault = Sentence{s.name, ": ", fault}; };
    if (Sentence fault = systems::check_nodes(s); !fault.empty()) return refuse(fault), plan;
    if (Sentence fault = systems::resolve_crossings(s, plan); !fault.empty()) return refuse(fault), plan;
    if (Sentence fault = systems::add_frames(s, plan); !fault.empty()) return refuse(fault), plan;
    const std::size_t bad = systems::number_frames(s, plan, analysis);
    const bool in_time = bad == plan.frames.size();
    systems::name_layouts(s, plan);
    if (Sentence fault = systems::check_frames(s, plan, in_time); !fault.empty()) return refuse(fault), plan;
    if (!in_time) return refuse(systems::late_fault(s, plan, bad)), plan;
    if (s.wire.has_clock())
        if (Sentence fault = systems::check_clock_error(s, {plan.frames.items.data(), plan.frames.size()},
                                                        plan.clock_error);
            !fault.empty())
            return refuse(fault), plan;
    return plan;
}

} // namespace tappet

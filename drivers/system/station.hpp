// The machine of one node: its own table followed by its end of the wire. Also the same system without a
// wire, in one machine: local and distributed rows behave alike.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/can/clock.hpp"
#include "drivers/can/restarter.hpp"
#include "drivers/system/link.hpp"
#include "kernel/system/joined.hpp"

namespace tappet::systems {

/// A bus that carries only the system's frames.
inline constexpr auto no_signals = can::signal_map();

template <const auto& system, std::size_t n>
struct StationRows {
    using Rows = NodeRows<system, n>;
    static constexpr auto& plan = Rows::plan;
    static constexpr std::size_t frame_count = plan.frames.size();

    // ---- the frames, for the bus and its proof

    static constexpr bool is_heard(const WireFrame& frame) {
        if (frame.node == n) return false;
        if (frame.kind == WireFrameKind::beat || frame.is_of_clock()) return true;
        if (frame.kind != WireFrameKind::data) return Rows::has_part(frame.crossing);
        for (std::size_t x = 0; x < system.crossings.size(); ++x)
            if (system.crossings[x].kind == CrossingKind::data &&
                &plan.frames[plan.place[x].frame] == &frame && plan.index[x].to.node == n)
                return true;
        return false;
    }
    using FrameName = Text<96>;
    static constexpr auto frame_names = array_of<frame_count>([](std::size_t f) {
        const WireFrame& frame = plan.frames[f];
        constexpr std::string_view what[] = {"beat of ",  "data of ", "",          "answer to ",
                                             "reply to ", "taken: ",  "clock of ", "clock of "};
        FrameName name;
        name.append(what[static_cast<std::size_t>(frame.kind)]);
        name.append(frame.crossing == nowhere           ? system.nodes[frame.node].name
                    : frame.kind == WireFrameKind::data ? system.crossings[frame.crossing].from()
                                                        : system.crossings[frame.crossing].to());
        return name;
    });
    /// A node that is alone on the wire gets no acknowledgement: it retries for about half an hour, until
    /// another node is present; after that it needs service.
    static constexpr std::uint32_t restarts = 1000;
    static constexpr Duration restart_pause = 2s;

    // ---- contents of the frames, for tools

    using SignalName = Text<64>;
    /// The name of a value is its path, with '_' for '.'.
    static constexpr auto value_names = array_of<system.crossings.size()>([](std::size_t x) {
        SignalName name;
        for (const char each : system.crossings[x].from())
            name.append(each == '.' ? std::string_view{"_"} : std::string_view{&each, 1});
        return name;
    });
    static constexpr can::Signal field(std::string_view name, std::size_t start, std::size_t bits) {
        return can::signal(name, static_cast<std::uint16_t>(start), static_cast<std::uint8_t>(bits));
    }
    /// Returns a signal without bits where a DBC file cannot describe the value.
    static constexpr can::Signal value_field(std::size_t x, const WireValue& value, std::size_t start,
                                             std::string_view name) {
        const Facet* facet = plan.index[x].from.facet;
        const TypeId type = facet->type->kind == ValueKind::arguments && facet->type->elements.size() == 1
                                ? facet->type->elements[0]
                                : facet->type;
        can::Signal signal = field(name, start, value.bits);
        const bool as_it_is = value.kind == ValueKind::opaque;
        if (value.bits > 64 || (as_it_is && !type->arithmetic)) signal.bits = 0;
        if (as_it_is && type->kind == ValueKind::real) return signal.as_float().in(facet->unit);
        if (as_it_is ? type->kind == ValueKind::integer : value.kind != ValueKind::boolean && value.is_signed)
            signal = signal.as_signed();
        return signal.times(value.step).in(system.crossings[x].kind == CrossingKind::data ? facet->unit : "");
    }
    /// Calls take(frame, signal) for each signal.
    static constexpr void each_signal(auto take) {
        for (std::size_t f = 0; f < frame_count; ++f) {
            const WireFrame& frame = plan.frames[f];
            constexpr WireShape shape = plan.shape;
            if (frame.is_of_clock()) continue; // see can::ClockFrame
            constexpr std::size_t counter = system.wire.is_fd() ? 16 : 8;
            take(f, field("checksum", 0, counter));
            take(f, field("counter", counter, shape.protection_bits - counter));
            if (frame.kind == WireFrameKind::beat) {
                take(f, field("runs", shape.protection_bits, 4));
                take(f, field("epoch", shape.head_bits, 16));
                take(f, field("row", shape.head_bits + 16u, 16));
                take(f, field("layout", shape.head_bits + 32u, 16));
            } else if (frame.kind == WireFrameKind::data) {
                for (std::size_t p = 0; p < system.crossings.size(); ++p) {
                    if (system.crossings[p].kind != CrossingKind::data || plan.place[p].frame != f) continue;
                    bool is_first = true; // one signal for all readers of a value
                    for (std::size_t q = 0; q < p; ++q)
                        is_first &= system.crossings[q].from() != system.crossings[p].from();
                    if (const can::Signal value =
                            value_field(p, plan.index[p].value, plan.place[p].at + 1u, value_names[p].view());
                        is_first && value.bits != 0)
                        take(f, value);
                }
            } else {
                take(f, field("word", shape.protection_bits, 4));
                take(f, field("number", shape.head_bits, 8));
                take(f, field("session", shape.head_bits + 8u, 8));
                if (frame.kind == WireFrameKind::message)
                    if (const can::Signal value = value_field(
                            frame.crossing, plan.index[frame.crossing].value, shape.channel_bits(), "value");
                        value.bits != 0)
                        take(f, value);
            }
        }
    }
    static constexpr std::size_t signal_count = [] {
        std::size_t count = 0;
        each_signal([&](std::size_t, const can::Signal&) { ++count; });
        return count;
    }();
    static constexpr auto services = [] {
        can::Services<frame_count, 0, signal_count> all{};
        std::size_t k = 0;
        each_signal([&](std::size_t f, const can::Signal& signal) {
            if (all.frames[f].values++ == 0) all.frames[f].first = k;
            all.signals[k++] = signal;
        });
        all.bit_rate = system.wire.rate.bits_per_second;
        all.data_bit_rate = system.wire.rate.in_data_phase;
        all.sends_itself = true;
        all.restarts_allowed = restarts;
        for (std::size_t f = 0; f < frame_count; ++f) {
            const WireFrame& frame = plan.frames[f];
            can::FrameRow& row = all.frames[f];
            row.identifier = identifier_of(system.wire, frame);
            row.name = frame_names[f].view();
            row.direction = frame.node == n   ? can::Direction::transmit
                            : is_heard(frame) ? can::Direction::receive
                                              : can::Direction::passing;
            row.length = frame.bytes;
            row.format = format_of(system.wire, frame);
            row.every = frame.kind == WireFrameKind::beat || frame.kind == WireFrameKind::data ? frame.apart
                                                                                               : Duration{};
            row.apart = frame.apart;
            row.jitter = frame.jitter;
            row.is_proven = frame.node != n;
        }
        return all;
    }();
    /// Most wake-ups of its activity within its own deadline: by each frame received or confirmed, as many as
    /// the wire has room for, by its timers and by its machine's events.
    static constexpr std::int64_t wakes = [] {
        const Duration window = system.wire.service.deadline;
        std::int64_t on_wire = 0, timers = 0;
        Duration shortest = Duration::max();
        for (const WireFrame& frame : plan.frames) {
            if (frame.node != n && !is_heard(frame)) continue;
            on_wire += (window + frame.jitter) / frame.apart + 1;
            shortest = std::min(shortest, Duration{can::least_time_ns(frame.on_wire.count())});
            if (frame.node == n && frame.kind != WireFrameKind::answer &&
                frame.kind != WireFrameKind::received)
                timers += window / frame.apart + 1;
        }
        std::int64_t events = 1;
        for (std::size_t i = 0; i < Rows::row_count; ++i)
            if (Rows::is_command(i) || Rows::sends_events(i))
                ++events; // a held one is sent by the timer of its frame
        return std::min(on_wire, window / shortest + 1) + timers + events;
    }();

    static constexpr Sentence wake_fault =
        wakes <= Engine::max_wakes_watched
            ? Sentence{}
            : Sentence(system.name, ": node \"", system.nodes[n].name, "\" may be woken ", wakes,
                       " times by its wire within served_within(...), and ", Engine::max_wakes_watched,
                       " are watched: serve it within a shorter time, or let fewer rows begin and end there");
    TAPPET_ACCEPTED(wake_fault);

    // ---- the rows

    using Path = Text<127>;
    static constexpr Path path(std::string_view facet, std::string_view end_of_component) {
        Path text;
        text.append(system.wire.name);
        text.append(end_of_component);
        text.append(".");
        text.append(facet);
        return text;
    }
    static constexpr Text<64> component_name(std::string_view end) {
        Text<64> text;
        text.append(system.wire.name);
        text.append(end);
        return text;
    }
    static constexpr auto bus_name = component_name("_can"), restarter_name = component_name("_restarter"),
                          clock_name = component_name("_clock");
    static constexpr auto bus_services = path("services", "_can"), received = path("received", "");
    static constexpr auto bus_faulted = path("faulted", "_can"), faulted = path("faulted", "_restarter");
    static constexpr auto clock_received = path("received", "_clock"), clock_ahead = path("ahead", "_clock"),
                          clock_known = path("known", "_clock"),
                          clock_exchanges = path("exchanges", "_clock"), ahead = path("ahead", ""),
                          exchanges = path("exchanges", ""), knows_time = path("knows_time", "");
    template <std::size_t N>
    static constexpr auto paths(const std::array<FacetName, N>& facets) {
        return array_of<N>([&](std::size_t i) { return path(facets[i].view(), ""); });
    }
    static constexpr auto port_paths = paths(Rows::port_names), row_paths = paths(Rows::row_names),
                          loss_paths = paths(Rows::loss_names), presence_paths = paths(Rows::presence_names);

    static constexpr std::string_view port_path(std::size_t x) {
        for (std::size_t p = 0; p < Rows::port_count; ++p)
            if (system.crossings[Rows::ports[p].crossing].data.from == system.crossings[x].data.from)
                return port_paths[p].view();
        return {};
    }
    static constexpr std::size_t connection_count = [] {
        std::size_t count = 2 + (Rows::is_told_time ? 4u : 0u);
        for (const PortPlace& port : Rows::ports) count += port.is_input ? 1u : 0u;
        for (std::size_t x = 0; x < system.crossings.size(); ++x)
            count += plan.index[x].to.node == n && (system.crossings[x].kind == CrossingKind::data ||
                                                    system.crossings[x].kind == CrossingKind::presence)
                         ? 1u
                         : 0u;
        return count;
    }();
    static constexpr auto connections = [] {
        std::array<ConnectionRow, connection_count> all{};
        std::size_t k = 0;
        all[k++] = buffer<64>(bus_services.view(), received.view());
        all[k++] = data(bus_faulted.view(), faulted.view());
        if constexpr (Rows::is_told_time) {
            all[k++] = buffer<64>(bus_services.view(), clock_received.view());
            all[k++] = data(clock_ahead.view(), ahead.view());
            all[k++] = data(clock_known.view(), knows_time.view());
            all[k++] = data(clock_exchanges.view(), exchanges.view());
        }
        for (std::size_t p = 0; p < Rows::port_count; ++p) {
            if (!Rows::ports[p].is_input) continue;
            ConnectionRow& row = all[k++];
            row = data(in_node(system.crossings[Rows::ports[p].crossing].data.from), port_paths[p].view());
            if (Rows::ports[p].max_age > Duration::zero()) row.max_age = Rows::ports[p].max_age;
        }
        for (std::size_t x = 0; x < system.crossings.size(); ++x) {
            const Crossing& crossing = system.crossings[x];
            if (plan.index[x].to.node != n) continue;
            if (crossing.kind != CrossingKind::data && crossing.kind != CrossingKind::presence) continue;
            ConnectionRow& row = all[k++];
            row = crossing.data;
            row.from = crossing.kind == CrossingKind::data ? port_path(x)
                                                           : presence_paths[plan.index[x].from.node].view();
            row.to = in_node(crossing.data.to);
        }
        return all;
    }();

    static constexpr std::size_t reaction_count = [] {
        std::size_t count = 0;
        for (std::size_t i = 0; i < Rows::row_count; ++i) {
            const Crossing& row = Rows::crossing(i);
            if (row.kind == CrossingKind::data) continue;
            count +=
                row.kind == CrossingKind::event && Rows::is_from_here(i) && !row.if_lost.empty() ? 2u : 1u;
        }
        return count;
    }();
    static constexpr auto reactions = [] {
        std::array<ReactionRow, reaction_count> all{};
        std::size_t k = 0;
        for (std::size_t i = 0; i < Rows::row_count; ++i) {
            const Crossing& row = Rows::crossing(i);
            const std::string_view here = row_paths[i].view();
            if (row.kind == CrossingKind::command) {
                all[k++] =
                    Rows::is_from_here(i) ? uses(in_node(row.from()), here) : uses(here, in_node(row.to()));
            } else if (row.kind == CrossingKind::event) {
                ReactionTarget target = row.reaction.target;
                target.operation = Rows::is_from_here(i) ? here : in_node(row.to());
                all[k++] = when(Rows::is_from_here(i) ? in_node(row.from()) : here, target);
                if (Rows::is_from_here(i) && !row.if_lost.empty())
                    all[k++] = when(loss_paths[i].view(), tell(in_node(row.if_lost)));
            }
        }
        return all;
    }();
    // ---- the common clock, after the bus and before the end that reads it

    static constexpr can::ClockRow clock_row = [] {
        can::ClockRow row{};
        for (const WireFrame& frame : plan.frames)
            if (frame.kind == WireFrameKind::sync)
                row = can::clock(identifier_of(system.wire, frame),
                                 can::every(system.wire.clock.every, system.wire.service.deadline));
        return row;
    }();
    static constexpr auto clock_component = [] {
        if constexpr (Rows::tells_time)
            return std::array{
                component<can::ClockTeller<clock_row>>(clock_name.view(), device(system.wire.name))};
        else if constexpr (Rows::is_told_time)
            return std::array{component<can::ToldClock<clock_row>>(
                clock_name.view(), set("teller_late", system.wire.clock.stamps_late),
                set("own_late", system.wire.clock.stamps_late), set("drift", system.wire.clock.drift),
                set("within", system.wire.clock.within))};
        else
            return std::array<ComponentRow, 0>{};
    }();

    static constexpr auto components = both(
        std::array<ComponentRow, 3>{
            component<can::Bus<no_signals, services>>(bus_name.view(), device(system.wire.name)),
            component<Link<system, n>>(system.wire.name, device(system.wire.name)),
            component<can::Restarter>(restarter_name.view(), device(system.wire.name),
                                      set("attempts", restarts), set("pause", restart_pause))},
        clock_component);
    static constexpr std::array<ActivityRow, 2> activities = [] {
        ActivityRow serves =
            activity(system.wire.name, on_device(bus_name.view()),
                     at_most(wakes, system.wire.service.deadline), runs(bus_name.view()),
                     deadline(system.wire.service.deadline), budget(system.wire.service.budget));
        if (system.wire.has_clock()) static_cast<void>(serves.runs.push(clock_name.view()));
        static_cast<void>(serves.runs.push(system.wire.name));
        return std::array{
            activity(restarter_name.view(), every(100ms), not_real_time, runs(restarter_name.view())),
            serves};
    }();
};

/// Returns the number of a node; an unknown name does not compile.
template <const auto& system>
constexpr std::size_t number_of(std::string_view name) {
    return find_node(system.view(), name);
}

} // namespace tappet::systems

namespace tappet {

/// The firmware of a node; `table` is the one that its row of the system names.
template <const auto& system, text name, const auto& table>
inline constexpr auto station = [] {
    constexpr std::size_t n = systems::number_of<system>(name.view());
    static_assert(n != nowhere, "the system has no node of that name");
    static_assert(system.nodes[n].table.components.data() == table.components.data(),
                  "that node's row of the system names another table");
    using Rows = systems::StationRows<system, n>;
    return systems::joined(system.nodes[n].name, table, Rows::components, Rows::activities, Rows::connections,
                           Rows::reactions);
}();

} // namespace tappet

// The rows of a system that involve one node, and the places of their stand-ins in its end of the wire.
#pragma once

#include "drivers/system/wire_analysis.hpp"
#include "kernel/base/array_of.hpp"
#include "kernel/component/facet_name.hpp"
#include "kernel/system/promises.hpp"

namespace tappet::systems {

/// The plan of a system at namespace scope: computed once.
template <const auto& system>
inline constexpr auto plan_of = plan_system(system, &analyse_can);

/// The proven time of each promise of the system, or the first promise that is not kept.
template <const auto& system>
inline constexpr auto promises_of = [] {
    struct {
        Sentence fault{};
        std::array<Duration, system.promises.size()> proven{};
    } all;
    if (plan_of<system>.fault.empty()) {
        all.fault = check_promises(system.view(), plan_of<system>, all.proven);
        if (!all.fault.empty()) all.fault = Sentence{system.name, ": ", all.fault};
    }
    return all;
}();

/// A port of the node's end: an input for a value that its machine sends, an output for one that it receives.
struct PortPlace {
    const Facet* facet = nullptr; ///< the port that it stands in for
    bool is_input = false;
    std::size_t crossing = nowhere; ///< the first of those that share the port
    std::size_t row = nowhere;
    std::size_t frame = nowhere;
    std::uint16_t bit = 0; ///< position of its valid bit; the value follows it
    WireValue value{};
    Duration max_age{}; ///< of the readers: the shortest if sent, the longest if received
    std::size_t at = 0; ///< offset in the storage
};

/// An event, a command, or a value; presences need none.
struct RowPlace {
    std::size_t crossing = nowhere;
    std::uint16_t name = 0, layout = 0;
    std::size_t event_at = nowhere; ///< offset in the storage, of a received event
};

template <const auto& system, std::size_t n>
struct NodeRows {
    static constexpr auto& plan = plan_of<system>;
    TAPPET_ACCEPTED(plan.fault);
    TAPPET_ACCEPTED(promises_of<system>.fault);
    static constexpr std::size_t crossing_count = system.crossings.size();

    static constexpr bool has_part(std::size_t x) {
        return system.crossings[x].kind != CrossingKind::presence &&
               (plan.index[x].from.node == n || plan.index[x].to.node == n);
    }
    static constexpr std::size_t row_count = [] {
        std::size_t count = 0;
        for (std::size_t x = 0; x < crossing_count; ++x) count += has_part(x) ? 1u : 0u;
        return count;
    }();
    /// Returns whether it is the first row of its port; readers of one value share a port.
    static constexpr bool is_first_port(std::size_t x) {
        for (std::size_t before = 0; before < x; ++before)
            if (system.crossings[before].kind == CrossingKind::data && has_part(before) &&
                system.crossings[before].data.from == system.crossings[x].data.from)
                return false;
        return true;
    }
    static constexpr std::size_t port_count = [] {
        std::size_t count = 0;
        for (std::size_t x = 0; x < crossing_count; ++x)
            count +=
                system.crossings[x].kind == CrossingKind::data && has_part(x) && is_first_port(x) ? 1u : 0u;
        return count;
    }();

private:
    struct Places {
        std::array<PortPlace, port_count> ports{};
        std::array<RowPlace, row_count> rows{};
        std::array<std::size_t, crossing_count> row_of{};
        std::size_t bytes = 64; // the storage must not be empty
    };
    /// The sender applies the strictest maximum age of the readers; the receiver passes an old value on to
    /// the most patient.
    static constexpr Duration stricter(Duration a, Duration b, bool is_told) {
        if (a == Duration::zero() || b == Duration::zero()) return std::max(a, b);
        return is_told ? std::min(a, b) : std::max(a, b);
    }
    static constexpr std::size_t on_a_line(std::size_t bytes) { return (bytes + 63) / 64 * 64; }
    static constexpr Places places = [] {
        Places all;
        std::size_t row = 0, port = 0;
        for (std::size_t x = 0; x < crossing_count; ++x) {
            all.row_of[x] = nowhere;
            if (!has_part(x)) continue;
            const Crossing& crossing = system.crossings[x];
            const CrossingIndex& index = plan.index[x];
            all.row_of[x] = row;
            RowPlace& place = all.rows[row];
            place = {x, index.name, index.layout, nowhere};
            if (crossing.kind == CrossingKind::event && index.to.node == n) {
                place.event_at = all.bytes;
                all.bytes += on_a_line(index.from.facet->event->event_bytes);
            }
            if (crossing.kind == CrossingKind::data && is_first_port(x)) {
                const bool is_input = index.from.node == n;
                const PortOperations& operations = *index.from.facet->port;
                all.ports[port++] = {index.from.facet,
                                     is_input,
                                     x,
                                     row,
                                     plan.place[x].frame,
                                     plan.place[x].at,
                                     index.value,
                                     crossing.data.max_age,
                                     all.bytes};
                all.bytes += on_a_line(is_input ? operations.input_bytes : operations.output_bytes);
            }
            ++row;
        }
        for (PortPlace& each : all.ports)
            for (std::size_t x = 0; x < crossing_count; ++x)
                if (has_part(x) && system.crossings[x].kind == CrossingKind::data &&
                    system.crossings[x].data.from == system.crossings[each.crossing].data.from)
                    each.max_age = stricter(each.max_age, system.crossings[x].data.max_age, each.is_input);
        return all;
    }();

public:
    static constexpr auto& ports = places.ports;
    static constexpr auto& rows = places.rows;
    static constexpr std::size_t storage_bytes = places.bytes;

    // ---- the common clock

    static constexpr bool tells_time =
        system.wire.has_clock() && system.nodes[n].name == system.wire.clock.node;
    static constexpr bool is_told_time = system.wire.has_clock() && !tells_time;
    static constexpr std::size_t teller = find_node(system.view(), system.wire.clock.node);

    /// Bytes of a command's arguments and results; the largest.
    static constexpr std::size_t command_bytes = [] {
        std::size_t most = 1;
        for (const CrossingIndex& each : plan.index)
            most = std::max(most, std::size_t{each.value.bytes} + each.result.bytes);
        return most;
    }();
    /// Returns the index of the frame with that identifier; the number of frames when there is none.
    static constexpr std::size_t frame_of(std::uint32_t id) noexcept TAPPET_REALTIME {
        std::size_t first = 0, past = plan.frames.size();
        while (first < past) {
            const std::size_t middle = (first + past) / 2;
            if (plan.frames[middle].id < id)
                first = middle + 1;
            else
                past = middle;
        }
        return first < plan.frames.size() && plan.frames[first].id == id ? first : plan.frames.size();
    }

    static constexpr std::size_t row_of(std::size_t x) noexcept TAPPET_REALTIME {
        return x < crossing_count ? places.row_of[x] : nowhere;
    }
    static constexpr const Crossing& crossing(std::size_t i) noexcept TAPPET_REALTIME {
        return system.crossings[rows[i].crossing];
    }
    static constexpr const CrossingIndex& index(std::size_t i) noexcept TAPPET_REALTIME {
        return plan.index[rows[i].crossing];
    }
    static constexpr const Facet& facet_from(std::size_t i) { return *index(i).from.facet; }
    static constexpr const CommandOperations& command(std::size_t i) { return *index(i).to.facet->command; }
    static constexpr bool is_from_here(std::size_t i) noexcept TAPPET_REALTIME {
        return index(i).from.node == n;
    }
    static constexpr std::size_t other(std::size_t i) noexcept TAPPET_REALTIME {
        return is_from_here(i) ? index(i).to.node : index(i).from.node;
    }
    static constexpr bool is_command(std::size_t i) noexcept TAPPET_REALTIME {
        return crossing(i).kind == CrossingKind::command;
    }
    static constexpr bool sends_events(std::size_t i) noexcept TAPPET_REALTIME {
        return crossing(i).kind == CrossingKind::event && is_from_here(i);
    }
    static constexpr bool serves_command(std::size_t i) noexcept TAPPET_REALTIME {
        return is_command(i) && !is_from_here(i);
    }
    /// Returns the frame in which the row's messages leave this node.
    static constexpr std::size_t message_frame(std::size_t i) noexcept TAPPET_REALTIME {
        const CrossingPlace& place = plan.place[rows[i].crossing];
        return is_from_here(i) ? place.frame : place.reply;
    }
    /// Time in which each row's message must be sent; a later one could be served after its deadline. Replies
    /// have no promised time.
    static constexpr std::array<Duration, row_count> sent_by = [] {
        std::array<Duration, row_count> all{};
        for (std::size_t i = 0; i < row_count; ++i) {
            all[i] = crossing(i).within;
            if (crossing(i).kind != CrossingKind::data && is_from_here(i))
                all[i] -= plan.frames[message_frame(i)].worst + system.wire.service.deadline +
                          read_within(system.view(), index(i).to);
        }
        return all;
    }();
    static constexpr bool is_periodic(std::size_t f) noexcept TAPPET_REALTIME {
        const WireFrame& frame = plan.frames[f];
        return frame.node == n && (frame.kind == WireFrameKind::beat || frame.kind == WireFrameKind::data);
    }
    static constexpr std::size_t beat_frame = [] {
        std::size_t found = 0;
        while (plan.frames[found].kind != WireFrameKind::beat || plan.frames[found].node != n) ++found;
        return found;
    }();

    // ---- names: a sent facet has its path in the machine, a received one its path in the other node

    static constexpr auto port_names = array_of<port_count>([](std::size_t p) {
        const std::string_view path = system.crossings[ports[p].crossing].data.from;
        return FacetName{ports[p].is_input ? in_node(path) : path};
    });
    /// Name of an event or a command: "station.out>drill.station.in" where it leaves,
    /// "saw.station.out>station.in" where it arrives.
    static constexpr FacetName row_name(std::size_t i, std::string_view end) {
        const Crossing& row = crossing(i);
        if (row.kind == CrossingKind::data) return {};
        return {is_from_here(i) ? in_node(row.from()) : row.from(), ">",
                is_from_here(i) ? row.to() : in_node(row.to()), end};
    }
    static constexpr auto row_names = array_of<row_count>([](std::size_t i) { return row_name(i, ""); });
    static constexpr auto loss_names =
        array_of<row_count>([](std::size_t i) { return row_name(i, " lost"); });
    static constexpr auto presence_names = array_of<system.nodes.size()>(
        [](std::size_t node) { return FacetName{system.nodes[node].name, ".is_there"}; });
    /// Number of facets of the events and commands.
    static constexpr std::size_t facet_count = [] {
        std::size_t count = 0;
        for (std::size_t i = 0; i < row_count; ++i)
            count += crossing(i).kind == CrossingKind::data ? 0u : sends_events(i) ? 2u : 1u;
        return count;
    }();

    static Text<160> refusal(std::size_t i, bool has_it) noexcept TAPPET_REALTIME {
        Text<160> text;
        text.append("node \"");
        text.append(system.nodes[other(i)].name);
        text.append(has_it ? "\" has another row \"" : "\" has no row \"");
        text.append(crossing(i).from());
        text.append("\" -> \"");
        text.append(crossing(i).to());
        text.append("\": give both one version of the system");
        return text;
    }
};

} // namespace tappet::systems

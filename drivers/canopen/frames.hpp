// The frames of a network's manager other than process data.
#pragma once

#include "drivers/can/services.hpp"
#include "drivers/canopen/network_rows.hpp"
#include "kernel/base/array_of.hpp"
#include "kernel/component/facet_name.hpp"

namespace tappet::canopen {

constexpr can::Frame nmt_frame(NmtCommand command, std::uint8_t node) noexcept TAPPET_REALTIME {
    return {.id = cob::nmt, .length = 2, .data = {static_cast<std::uint8_t>(command), node}};
}
constexpr can::Frame heartbeat_frame(std::uint8_t node, NmtState state) noexcept TAPPET_REALTIME {
    return {.id = cob::heartbeat + node, .length = 1, .data = {static_cast<std::uint8_t>(state)}};
}

/// Returns a SYNC frame, with `counter` in it unless `overflow` is 0.
constexpr can::Frame sync_frame(std::uint8_t overflow, std::uint8_t counter) noexcept TAPPET_REALTIME {
    if (overflow == 0) return {.id = cob::sync};
    return {.id = cob::sync, .length = 1, .data = {counter}};
}

/// Least time between two SDO requests to one node, and between two NMT commands. The manager observes both;
/// the bus is proven for the commands.
inline constexpr Duration requests_apart = 1ms;
inline constexpr Duration commands_apart = 10ms;

namespace detail {

/// "NODE.heartbeat" and similar names of the services' frames in charts and summaries.
template <const auto& map> struct ServiceNames {
    static constexpr std::array<std::string_view, 4> kinds{".emergency", ".sdo_answer", ".heartbeat",
                                                           ".sdo_request"};
    static constexpr auto names = array_of<kinds.size() * map.nodes.size()>(
        [](std::size_t i) { return FacetName{map.nodes[i / kinds.size()].name, kinds[i % kinds.size()]}; });
};

} // namespace detail

/// Services for can::Bus<signals, frames<network>>. When the bus stops, or the machine's process has ended,
/// the nodes take the safe values and leave their operational state. Emergency messages and SDO transfers
/// have no rate and are not part of the bus's proof: they occur before the network is operational, or after a
/// node's fault.
template <const auto& map>
inline constexpr auto frames = [] {
    constexpr std::size_t n = map.nodes.size();
    constexpr ManagerRow manager = map.manager;
    constexpr bool beats = manager.beats != Duration{}, synchronises = manager.sync_every != Duration{},
                   tells_time = manager.time_every != Duration{};
    can::Services<4 * n + 1 + (beats ? 1 : 0) + (synchronises ? 1 : 0) + (tells_time ? 1 : 0),
                  1u + (synchronises ? 1u : 0u)>
        all;
    std::size_t used = 0;
    // The manager's frames are not on the bus's own time grid: they have a rate, but no period there.
    const auto add = [&](std::uint32_t id, std::string_view name, can::Direction direction,
                         std::uint8_t length, Duration every, Duration apart) {
        all.frames[used++] = {{name}, {every, apart}, can::standard(id), direction, length};
    };
    using enum can::Direction;
    for (std::size_t i = 0; i < n; ++i) {
        const NodeRow& node = map.nodes[i];
        const auto name = [&](std::size_t kind) {
            return detail::ServiceNames<map>::names[4 * i + kind].view();
        };
        add(cob::emergency + node.id, name(0), receive, 8, {}, {});
        add(cob::sdo_answer + node.id, name(1), receive, 8, {}, {});
        add(cob::heartbeat + node.id, name(2), receive, 1, node.beats, node.beats);
        add(cob::sdo_request + node.id, name(3), transmit, 8, {}, {});
    }
    add(cob::nmt, "nmt", transmit, 2, {}, commands_apart);
    if (beats) add(cob::heartbeat + manager.id, "manager.heartbeat", transmit, 1, {}, manager.beats);
    if (synchronises)
        add(cob::sync, "sync", transmit, manager.sync_overflow != 0 ? 1 : 0, {}, manager.sync_every);
    if (tells_time) add(cob::time, "time", transmit, 6, {}, manager.time_every);
    // Synchronous PDOs take effect with the next SYNC.
    if constexpr (synchronises) all.safe[0] = sync_frame(manager.sync_overflow, 1);
    all.safe.back() = nmt_frame(NmtCommand::enter_pre_operational, 0);
    return all;
}();

} // namespace tappet::canopen

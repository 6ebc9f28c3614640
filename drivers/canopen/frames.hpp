// What a network's manager takes from the bus and sends to it beside the process data.
#pragma once

#include "drivers/can/services.hpp"
#include "drivers/canopen/network_rows.hpp"

namespace tappet::canopen {

constexpr can::Frame nmt_frame(NmtCommand command, std::uint8_t node) noexcept TAPPET_REALTIME {
    can::Frame frame;
    frame.id = cob::nmt;
    frame.length = 2;
    frame.data = {static_cast<std::uint8_t>(command), node};
    return frame;
}
constexpr can::Frame heartbeat_frame(std::uint8_t node, NmtState state) noexcept TAPPET_REALTIME {
    can::Frame frame;
    frame.id = cob::heartbeat + node;
    frame.length = 1;
    frame.data = {static_cast<std::uint8_t>(state)};
    return frame;
}

/// For can::Bus<signals, frames<network>>. When the machine's process is no more, the nodes leave their
/// operational state.
template <const auto& map>
inline constexpr auto frames = [] {
    constexpr std::size_t n = map.nodes.size();
    constexpr bool beats = map.manager.beats != Duration{},
                   synchronises = map.manager.sync_every != Duration{},
                   tells_time = map.manager.time_every != Duration{};
    can::Services<3 * n, n + 1 + (beats ? 1 : 0) + (synchronises ? 1 : 0) + (tells_time ? 1 : 0), 1> all;
    std::size_t taken = 0, sent = 0;
    for (const NodeRow& node : map.nodes) {
        for (const std::uint32_t base : {cob::emergency, cob::sdo_answer, cob::heartbeat})
            all.receive[taken++] = can::standard(base + node.id);
        all.transmit[sent++] = can::standard(cob::sdo_request + node.id);
    }
    all.transmit[sent++] = can::standard(cob::nmt);
    if (beats) all.transmit[sent++] = can::standard(cob::heartbeat + map.manager.id);
    if (synchronises) all.transmit[sent++] = can::standard(cob::sync);
    if (tells_time) all.transmit[sent++] = can::standard(cob::time);
    all.safe[0] = nmt_frame(NmtCommand::enter_pre_operational, 0);
    return all;
}();

} // namespace tappet::canopen

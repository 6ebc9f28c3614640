// The machine's end of the loom's bus, for tests of its nodes: it makes and reads frames by the names of its
// map, and holds the requests of the network manager.
#pragma once

#include "apps/carpet_loom/network.hpp"
#include "drivers/can/signal_store.hpp"
#include "drivers/canopen/sdo.hpp"

#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

namespace tappet::loom {

using canopen::NmtCommand;
using canopen::NmtState;

/// Requests that configure a node; 0: all nodes.
inline std::vector<can::Frame> configuration(std::uint8_t node) {
    const auto& network = carpet::loom_network;
    std::vector<can::Frame> requests;
    for (std::size_t n = 0; n < network.nodes.size(); ++n) {
        if (node != 0 && network.nodes[n].id != node) continue;
        for (std::size_t i = network.first_step[n]; i < network.first_step[n + 1]; ++i) {
            const canopen::ConfigurationStep& step = network.steps[i];
            if (step.kind != canopen::ConfigurationStep::Kind::write) continue;
            can::Frame request;
            request.id = canopen::cob::sdo_request + network.nodes[n].id;
            request.length = 8;
            request.data = canopen::sdo::with_address(0x23u | (4u - step.bytes) << 2, step.at,
                                                      static_cast<std::uint32_t>(step.value));
            requests.push_back(request);
        }
    }
    return requests;
}
/// Requests that configure and start a node.
inline std::vector<can::Frame> start(std::uint8_t node) {
    std::vector<can::Frame> frames = configuration(node);
    frames.push_back(canopen::nmt_frame(NmtCommand::start, node));
    return frames;
}

class MachineSide {
public:
    /// Makes a frame of the map with these signals.
    can::Frame frame(std::string_view name,
                     std::initializer_list<std::pair<std::string_view, std::int64_t>> signals) {
        const std::size_t row = map.frame(name);
        for (const auto& [signal, value] : signals)
            store_.set_bits(index(name, signal), static_cast<std::uint64_t>(value));
        return store_.encode(row, Time{});
    }
    /// Returns the frame's name; empty: the map has no such frame.
    std::string_view take(const can::Frame& frame) {
        std::size_t row = no_such;
        return store_.decode(frame, row) == can::Decoded::yes ? map.frames[row].name : std::string_view{};
    }
    /// A value of the last received frame of that name, before factor and offset.
    [[nodiscard]] std::int64_t integer(std::string_view frame, std::string_view signal) const {
        return store_.integer(index(frame, signal));
    }
    [[nodiscard]] double get(std::string_view frame, std::string_view signal) const {
        return store_.physical(index(frame, signal));
    }

private:
    static constexpr const auto& map = carpet::can_signals;
    static std::size_t index(std::string_view frame, std::string_view signal) {
        return map.signal(Sentence{frame, ".", signal}.view());
    }
    can::SignalStore<carpet::can_signals.frames.size(), carpet::can_signals.signals.size()> store_{map};
};

/// A drive's emergency message; the machine's map does not contain it.
struct Emergency {
    std::int64_t code = 0, error_register = 0;
    bool operator==(const Emergency&) const = default;
};
inline Emergency emergency_of(const can::Frame& frame) {
    return {frame.data[0] | frame.data[1] << 8, frame.data[2]};
}

} // namespace tappet::loom

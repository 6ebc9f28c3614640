// A signal map from a DBC file that the build made a constant: tappet_file() of CMake.
//
//     inline constexpr auto controller = can::node("controller",
//         can::transmit("drive_command", can::signal("controlword").safe(2), can::signal("speed").safe(0)));
//     inline constexpr auto can_signals = can::from_dbc<files::press_dbc, controller>;
//
// The map has the same type as one of can::signal_map(..), and its faults name line and column of the file.
#pragma once

#include "drivers/can/dbc/reader.hpp"
#include "drivers/can/dbc/taking.hpp"
#include "kernel/base/source_text.hpp"

namespace tappet::can {

namespace dbc {

template <const auto& file> inline constexpr auto network_of = [] {
    Store<room_for(file.text)> store;
    store.file = file.name;
    store.text = file.text;
    Network network = store.network();
    Reader{network}.read();
    store.keep(network);
    return store;
}();

/// The network with the node's part of it marked, and the sizes that this part needs.
template <const auto& file, const auto& node> struct Marked {
    std::remove_cvref_t<decltype(network_of<file>)> store = network_of<file>;
    Sizes sizes{};

    constexpr Marked() {
        Network network = store.network();
        if (network.fault.empty()) sizes = Taking{network, node.view()}.take();
        store.keep(network);
        if (!store.fault.empty()) sizes = {};
    }
};
template <const auto& file, const auto& node> inline constexpr Marked<file, node> marked{};

/// The node's map, and the data it points to.
template <const auto& file, const auto& node> struct Taken {
    static constexpr const Sizes& sizes = marked<file, node>.sizes;

    SignalMap<sizes.frames, sizes.signals> map{};
    std::array<ValueName, sizes.values> values{};
    std::array<char, sizes.characters> characters{};

    constexpr Taken() {
        auto store = marked<file, node>.store;
        Network network = store.network();
        if (network.fault.empty()) Taking{network, node.view()}.fill(map, values, characters);
        map.fault = network.fault;
    }
};
template <const auto& file, const auto& node> inline constexpr Taken<file, node> taken{};

} // namespace dbc

/// `file` is a SourceText, `node` the result of can::node(..): constexpr variables at namespace scope.
template <const auto& file, const auto& node>
inline constexpr const auto& from_dbc = dbc::taken<file, node>.map;

} // namespace tappet::can

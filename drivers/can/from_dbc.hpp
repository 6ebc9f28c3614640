// A signal map from a DBC file, of which the build made tables: tappet_file() of CMake.
//
//     inline constexpr auto controller = can::node("controller",
//         can::transmit("drive_command", can::signal("controlword").safe(2), can::signal("speed").safe(0)));
//     inline constexpr auto can_signals = can::from_dbc<files::press_dbc, controller>;
//
// The map has the same type as one of can::signal_map(..), and its faults name line and column of the file.
#pragma once

#include "drivers/can/dbc/table.hpp"
#include "drivers/can/dbc/taking.hpp"

namespace tappet::can {

namespace dbc {

/// The messages that may concern a node, and the room for their rows.
template <const auto& file, const auto& node> struct Candidates {
    std::array<bool, file.messages.size()> marks{};
    Room room = mark_candidates(file, node.view(), marks.data());
};
template <const auto& file, const auto& node> inline constexpr Candidates<file, node> candidates{};

/// Their rows with the node's part marked, and the sizes that this part needs.
template <const auto& file, const auto& node> struct Marked {
    Store<candidates<file, node>.room> store{};
    Sentence fault{file.fault};
    Sizes sizes{};

    constexpr Marked() {
        if (!fault.empty()) return;
        decode(file, candidates<file, node>.marks.data(), store.rows(), store.told.data());
        sizes = Taking{file, store.rows(), store.told.data(), node.view(), fault}.take();
        if (!fault.empty()) sizes = {};
    }
};
template <const auto& file, const auto& node> inline constexpr Marked<file, node> marked{};

/// The node's map, and the data it points to.
template <const auto& file, const auto& node> struct Taken {
    static constexpr const Sizes& sizes = marked<file, node>.sizes;

    SignalMap<sizes.frames, sizes.signals> map{};
    std::array<ValueName, sizes.values> values{};

    constexpr Taken() {
        map.fault = marked<file, node>.fault;
        if (!map.fault.empty()) return;
        auto store = marked<file, node>.store;
        Taking{file, store.rows(), store.told.data(), node.view(), map.fault}.fill(map, values.data());
    }
};
template <const auto& file, const auto& node> inline constexpr Taken<file, node> taken{};

} // namespace dbc

/// `file` is a table made by tappet_file(), `node` the result of can::node(..): constexpr variables at
/// namespace scope.
template <const auto& file, const auto& node>
    requires std::same_as<std::remove_cvref_t<decltype(file)>, dbc::Table>
inline constexpr const auto& from_dbc = dbc::taken<file, node>.map;

} // namespace tappet::can

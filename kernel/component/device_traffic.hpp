// The traffic of a driver's device, and whether the device can carry it. The table's check analyses it;
// charts and summaries show it.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/component/device_kind.hpp"

#include <span>
#include <string_view>

namespace tappet {

/// The device as the board describes it, and the response of its driver's activity.
struct DeviceUse {
    std::string_view device{};     ///< the board's name of it
    std::span<const Fact> facts{}; ///< facts of the board about it
    Duration response{};           ///< worst response of the activity that runs its driver
};

/// The name that crosses a device most often, by its map: the member `device_pace` of a driver that serves
/// its device once in each cycle of a periodic activity.
struct DevicePace {
    std::string_view name{};
    Duration apart{}; ///< least time between two; 0: it has none
};

/// Most names of a driver's traffic; so few that a row for each fits onto a stack.
inline constexpr std::size_t most_traffic_rows = 128;

/// The traffic under one name.
struct TrafficRow {
    std::string_view name{};
    bool sent = false;
    Duration period{};    ///< shortest time between two
    Duration wire_time{}; ///< longest time that one takes
    Duration deadline{};  ///< from its release
    Duration worst{};     ///< proven: from its release to its end on the wire; never: there is no bound
};

/// A driver's description of its device's traffic: the member `device_traffic` of its type.
struct DeviceTraffic {
    std::size_t rows = 0; ///< number of names that cross it
    /// Analyses the names in the order in which they win the device. Returns the first fault, with its cure;
    /// empty: all deadlines hold. `into` has that many rows, or is empty when nobody reads them.
    Sentence (*analyse)(const DeviceUse&, std::span<TrafficRow> into) = nullptr;
    /// Returns the longest time that was seen of what is sent under that name. Any thread.
    Duration (*longest_seen)(const void* component, std::string_view name) = nullptr;
};

} // namespace tappet

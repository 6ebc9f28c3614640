// What a driver's device has to carry, and whether it can: asked by the table's check, told by charts and
// summaries.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/component/device_kind.hpp"

#include <span>
#include <string_view>

namespace tappet {

/// The device as the board has it, and how it is driven.
struct DeviceUse {
    std::string_view device{};     ///< as the board calls it
    std::span<const Fact> facts{}; ///< what the board says of it
    Duration response{};           ///< the worst one of the activity that runs its driver
};

/// What a driver may name; so few, that a row for each fits onto a stack.
inline constexpr std::size_t most_traffic_rows = 128;

/// What crosses the device under one name.
struct TrafficRow {
    std::string_view name{};
    bool sent = false;
    Duration period{};    ///< the least time between two
    Duration wire_time{}; ///< the longest that one takes
    Duration deadline{};  ///< from its release
    Duration worst{};     ///< proven: from its release to its end on the wire; never: there is no bound
};

/// What a driver says of its device's traffic: the member `device_traffic` of its type.
struct DeviceTraffic {
    std::size_t rows = 0; ///< as many names cross it
    /// In the order in which they win the device. The first fault, with its cure; empty: all deadlines hold.
    /// `into` has as many rows, or is empty: nobody reads them.
    Sentence (*analyse)(const DeviceUse&, std::span<TrafficRow> into) = nullptr;
    /// Of what is sent under that name: the longest that was seen. Any thread.
    Duration (*longest_seen)(const void* component, std::string_view name) = nullptr;
};

} // namespace tappet

// The machines' values for Prometheus, as OpenMetrics text.
#pragma once

#include "toolchain/tools/gateway/station.hpp"

namespace tappet::network {

/// Counts of the gateway itself.
struct Counters {
    std::uint64_t connections = 0; ///< now
    std::uint64_t accepted = 0, turned_away = 0, frames_sent = 0, frames_lost = 0, requests = 0,
                  logins_failed = 0;
};

/// The two forms differ in the names of counters' families, and in the end.
enum class MetricsForm : std::uint8_t {
    open, ///< OpenMetrics 1.0
    plain ///< Prometheus' text format 0.0.4
};

/// Looks once at each machine. Values that are busy, never written or stale are left out: a missing value
/// cannot be taken for a present one.
[[nodiscard]] std::string metrics_text(std::span<const Station* const> stations, const Counters& counters,
                                       MetricsForm form);
/// Returns the text between the quotes of a label.
[[nodiscard]] std::string label_text(std::string_view text);

} // namespace tappet::network

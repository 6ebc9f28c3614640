// A twin as a swarm sees it: the outputs at its wire, and the faults that can strike it.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace tappet {

/// Periods, deadlines and queues on the way to a wire.
inline constexpr Duration usual_settling = 200ms;

/// The values that a wire can express.
struct WireNumbers {
    double least = 0, most = 0, step = 0;

    /// Orders the two ends: a factor may be negative.
    static WireNumbers between(double one, double other, double step) {
        return {std::min(one, other), std::max(one, other), step};
    }
};

/// One output of a machine at the wire. Not real-time; must not outlive the twin.
struct WireOutput {
    static constexpr std::size_t alone = ~std::size_t{0};

    std::string name{};                    ///< in the driver's map
    std::vector<std::string> operations{}; ///< that switch it; empty: the driver's input of its name
    std::optional<std::uint64_t> safe{};
    bool is_switch = false; ///< one bit
    Duration settles{};     ///< longest time from the driver's input to the wire, without `usual_settling`
    Duration recovers{};    ///< additional time after a fault of its driver
    /// Returns its value at the wire; none: not known.
    std::function<std::optional<std::uint64_t>(Time now)> read{};
    // For an output that is sent cyclically from its input.
    std::size_t goes_in = alone; ///< number of its frame or request
    WireNumbers numbers{};
    std::function<double(std::uint64_t)> physical{}; ///< null: another kind of output
};

/// A fault that has struck a twin.
struct TwinFault {
    std::string_view kind{};             ///< for statistics: "bus off"
    std::vector<Sentence> texts{};       ///< what happened
    std::function<bool(Time now)> end{}; ///< ends it, true: it has ended; null: it is over
    bool strikes_driver = true;          ///< its driver does not work meanwhile
    Duration misleads{};                 ///< so long the machine may have got any value
};

} // namespace tappet

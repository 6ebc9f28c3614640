// Counters of devices for their wires, under the names that the summary of a run uses.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/contract.hpp"

#include <cstdint>
#include <string_view>

namespace tappet {

/// The number of lost or wrongly received items (frames, edges, ..), summed over all devices of one kind.
struct WireCounter {
    std::string_view name{}; ///< "can_frames_lost": the name in the summary of a run
    std::uint64_t count = 0;
};
struct WireCounters {
    Bounded<WireCounter, 16> each{};
    constexpr void add(std::string_view name, std::uint64_t count) noexcept {
        for (WireCounter& one : each)
            if (one.name == name) {
                one.count += count;
                return;
            }
        TAPPET_CONTRACT(each.push({name, count}), Contract::index_out_of_range,
                        static_cast<std::int64_t>(each.size()), static_cast<std::int64_t>(each.capacity()));
    }
};

} // namespace tappet

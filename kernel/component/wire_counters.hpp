// What devices count of their wires, under the names that the summary of a run has.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/contract.hpp"

#include <cstdint>
#include <string_view>

namespace tappet {

/// What was lost on the wires, or came and was not as it must be: of all devices of a kind together.
struct WireCounter {
    std::string_view name{}; ///< "can_frames_lost": as the summary of a run has it
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

// Counters of devices for their wires, under the names that the summary of a run uses.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/contract.hpp"
#include "kernel/base/realtime.hpp"

#include <atomic>
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

/// How often a driver sent something else than what was written, or did not pass on what it received, since
/// the machine's start, whatever starts again in it. A value that its frame is sent with more than once
/// counts each time.
struct Unsent {
    std::uint64_t clamped = 0;   ///< outside its row's range: the nearest bound was sent
    std::uint64_t no_number = 0; ///< not a number: it was not sent, or of a row received, not passed on

    /// Counts a value; one thread counts, any thread reads.
    void count(bool is_clamped, bool is_no_number) noexcept TAPPET_REALTIME {
        std::atomic_ref{clamped}.store(clamped + is_clamped, std::memory_order_relaxed);
        std::atomic_ref{no_number}.store(no_number + is_no_number, std::memory_order_relaxed);
    }
    [[nodiscard]] Unsent read() const noexcept {
        auto& self = const_cast<Unsent&>(*this); // atomic_ref takes no const before C++26
        return {std::atomic_ref{self.clamped}.load(std::memory_order_relaxed),
                std::atomic_ref{self.no_number}.load(std::memory_order_relaxed)};
    }
};

} // namespace tappet

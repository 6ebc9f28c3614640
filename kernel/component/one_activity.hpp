// What belongs to one activity: a device, or whatever else is not shared.
#pragma once

#include "kernel/component/current.hpp"

#include <atomic>

namespace tappet {

/// The first activity that uses it is its owner from then on. A thread that runs none is let through: a
/// start-up, that of the makers, a test.
class OneActivity {
public:
    /// Another activity than the owner breaks contract 109. Real-time.
    void used() noexcept TAPPET_REALTIME {
        const std::uint32_t here = running_activity();
        if (here == no_activity) return;
        std::uint32_t owner = no_activity;
        if (owner_.compare_exchange_strong(owner, here, std::memory_order_relaxed)) return;
        TAPPET_CONTRACT(owner == here, Contract::one_activity, owner, here);
    }

private:
    std::atomic<std::uint32_t> owner_{no_activity};
};

} // namespace tappet

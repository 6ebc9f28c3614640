// Ownership by one activity: of a device, or of anything else that is not shared.
#pragma once

#include "kernel/component/current.hpp"

#include <atomic>

namespace tappet {

/// The first activity that uses it owns it from then on. Threads that run no activity may use it: start-up,
/// the makers' thread, a test.
class OneActivity {
public:
    /// Checks a use. An activity other than the owner breaks contract 109. Real-time.
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

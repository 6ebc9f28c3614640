// A one-shot timer: it wakes the component's activity at a time and runs one of its functions, between two
// cycles.
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/current.hpp"
#include "kernel/component/facet_member.hpp"

namespace tappet {

/// Owned by a component; its engine serves it because the component's interface names it. Used only from its
/// own activity. Real-time.
class Timer : FacetMember<member::timer> {
public:
    /// Fires once, at `when`; a time in the past fires at the engine's next look. Arming again moves it. To
    /// repeat, arm it for Cycle::after() when it fires. A timer that no engine serves would never fire: that
    /// breaks a contract.
    void arm(Time when) noexcept TAPPET_REALTIME {
        TAPPET_CONTRACT(is_served_, Contract::timer_unserved, to_ns(when), running_activity());
        when_ = when;
    }
    void cancel() noexcept TAPPET_REALTIME { when_ = never; }
    [[nodiscard]] Time when() const noexcept TAPPET_REALTIME { return when_; }

    /// Called by the engine that serves it from now on.
    void serve() noexcept { is_served_ = true; }

private:
    Time when_ = never;
    bool is_served_ = false;
};

} // namespace tappet

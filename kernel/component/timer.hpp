// A one-shot timer: it wakes the component's activity at a time and runs one of its functions, between two
// cycles.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

namespace tappet {

/// Owned by a component, served by its engine. From its own activity only. Real-time.
class Timer {
public:
    /// Once, at `when`; a time that is past fires at the engine's next look. Arming again moves it.
    void arm(Time when) noexcept TAPPET_REALTIME { when_ = when; }
    void cancel() noexcept TAPPET_REALTIME { when_ = never; }
    [[nodiscard]] Time when() const noexcept TAPPET_REALTIME { return when_; }

private:
    Time when_ = never;
};

} // namespace tappet

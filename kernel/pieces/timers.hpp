// Delays of bools in time (IEC 61131-3: TON, TOF, TP), and debouncing of inputs. Call each once a cycle with
// the cycle's time, which must not decrease; no timer runs by itself.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/pieces/edges.hpp"

namespace tappet {

/// True once its input has been true for the delay, until the input is false (TON). Real-time.
class OnDelay {
public:
    constexpr bool operator()(bool input, Duration delay, Time now) noexcept TAPPET_REALTIME {
        if (!input)
            since_ = never;
        else if (since_ == never)
            since_ = now;
        return input && now - since_ >= delay;
    }
    /// Returns how long the input has been true.
    [[nodiscard]] constexpr Duration elapsed(Time now) const noexcept TAPPET_REALTIME {
        return since_ == never ? Duration::zero() : now - since_;
    }
    constexpr void reset() noexcept TAPPET_REALTIME { since_ = never; }

private:
    Time since_ = never;
};

/// True while its input is true, and for the delay after it (TOF). Real-time.
class OffDelay {
public:
    constexpr bool operator()(bool input, Duration delay, Time now) noexcept TAPPET_REALTIME {
        was_ |= input;
        if (was_ && passed_(!input, delay, now)) was_ = false;
        return was_;
    }
    constexpr void reset() noexcept TAPPET_REALTIME { *this = {}; }

private:
    OnDelay passed_{};
    bool was_ = false;
};

/// True for the duration after a rising edge of its input, whatever the input does in the meantime (TP).
/// Real-time.
class Pulse {
public:
    constexpr bool operator()(bool input, Duration length, Time now) noexcept TAPPET_REALTIME {
        const bool rises = rises_(input);
        if (begun_ != never && now - begun_ >= length) begun_ = never;
        if (rises && begun_ == never) begun_ = now;
        return begun_ != never && length > Duration::zero();
    }
    constexpr void reset() noexcept TAPPET_REALTIME { *this = {}; }

private:
    RisingEdge rises_{};
    Time begun_ = never;
};

/// Accepts an input when it has stayed the same for the delay; accepts the first value at once. Debounce chip
/// lines with gpio::debounce instead: it filters before they wake a thread. Real-time.
class Debounced {
public:
    constexpr bool operator()(bool input, Duration settling, Time now) noexcept TAPPET_REALTIME {
        if (!known_) believed_ = input;
        known_ = true;
        if (differs_(input != believed_, settling, now)) {
            believed_ = input;
            differs_.reset();
        }
        return believed_;
    }
    constexpr void reset() noexcept TAPPET_REALTIME { *this = {}; }

private:
    OnDelay differs_{};
    bool believed_ = false, known_ = false;
};

} // namespace tappet

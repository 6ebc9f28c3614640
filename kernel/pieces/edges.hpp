// Edges of a bool from call to call (IEC 61131-3: R_TRIG, F_TRIG), and counters of them (CTU, CTD, CTUD).
#pragma once

#include "kernel/base/realtime.hpp"

#include <cstdint>
#include <limits>

namespace tappet {

/// True in the call in which the value became true. Unlike R_TRIG, the first value is no edge: a button held
/// during machine start has no effect. Real-time.
class RisingEdge {
public:
    constexpr bool operator()(bool now) noexcept TAPPET_REALTIME {
        const bool rises = now && !before_;
        before_ = now;
        return rises;
    }
    /// Treats the next value as the first one.
    constexpr void reset() noexcept TAPPET_REALTIME { before_ = true; }

private:
    bool before_ = true;
};

/// True in the call in which the value became false; the first value is no edge. Real-time.
class FallingEdge {
public:
    constexpr bool operator()(bool now) noexcept TAPPET_REALTIME { return rises_(!now); }
    constexpr void reset() noexcept TAPPET_REALTIME { rises_.reset(); }

private:
    RisingEdge rises_{};
};

/// Counts rising edges up to the end of its range. Real-time.
class UpCounter {
public:
    constexpr explicit UpCounter(std::int64_t preset = std::numeric_limits<std::int64_t>::max()) noexcept
        : preset_{preset} {}
    /// Returns whether the preset is reached.
    constexpr bool operator()(bool input) noexcept TAPPET_REALTIME {
        if (rises_(input) && value_ < std::numeric_limits<std::int64_t>::max()) ++value_;
        return reached();
    }
    constexpr void reset() noexcept TAPPET_REALTIME { value_ = 0; }
    [[nodiscard]] constexpr bool reached() const noexcept TAPPET_REALTIME { return value_ >= preset_; }
    [[nodiscard]] constexpr std::int64_t value() const noexcept TAPPET_REALTIME { return value_; }

private:
    RisingEdge rises_{};
    std::int64_t preset_;
    std::int64_t value_ = 0;
};

/// Counts rising edges of one input up and of the other down; both at once change nothing. Real-time.
class UpDownCounter {
public:
    constexpr explicit UpDownCounter(std::int64_t preset = std::numeric_limits<std::int64_t>::max()) noexcept
        : preset_{preset} {}
    constexpr void operator()(bool up, bool down) noexcept TAPPET_REALTIME {
        const bool rises = rises_(up), falls = falls_(down);
        if (rises && !falls && value_ < std::numeric_limits<std::int64_t>::max()) ++value_;
        if (falls && !rises && value_ > std::numeric_limits<std::int64_t>::min()) --value_;
    }
    constexpr void load(std::int64_t value) noexcept TAPPET_REALTIME { value_ = value; }
    [[nodiscard]] constexpr bool reached() const noexcept TAPPET_REALTIME { return value_ >= preset_; }
    [[nodiscard]] constexpr bool used_up() const noexcept TAPPET_REALTIME { return value_ <= 0; }
    [[nodiscard]] constexpr std::int64_t value() const noexcept TAPPET_REALTIME { return value_; }

private:
    RisingEdge rises_{}, falls_{};
    std::int64_t preset_;
    std::int64_t value_ = 0;
};

/// Counts rising edges down from its preset to zero. Real-time.
class DownCounter {
public:
    constexpr explicit DownCounter(std::int64_t preset) noexcept : preset_{preset}, value_{preset} {}
    /// Returns whether the count is zero.
    constexpr bool operator()(bool input) noexcept TAPPET_REALTIME {
        if (rises_(input) && value_ > 0) --value_;
        return used_up();
    }
    /// Restarts at the preset.
    constexpr void reset() noexcept TAPPET_REALTIME { value_ = preset_; }
    [[nodiscard]] constexpr bool used_up() const noexcept TAPPET_REALTIME { return value_ <= 0; }
    [[nodiscard]] constexpr std::int64_t value() const noexcept TAPPET_REALTIME { return value_; }

private:
    RisingEdge rises_{};
    std::int64_t preset_;
    std::int64_t value_;
};

} // namespace tappet

// What waits to be sent: bounded, in the order of arbitration, and nothing in it grows old unnoticed.
#pragma once

#include "drivers/can/device.hpp"
#include "kernel/base/bounded.hpp"

#include <cstddef>

namespace tappet::can {

/// Real-time: every call takes at most `capacity` steps.
class TransmitQueue {
public:
    static constexpr std::size_t capacity = 64;

    constexpr Send push(const Frame& frame, Keep keep) noexcept TAPPET_REALTIME {
        const std::uint32_t rank = arbitration(frame);
        std::size_t at = 0;
        while (at < frames_.size() && arbitration(frames_[at]) < rank) ++at;
        if (keep == Keep::latest && at < frames_.size() && arbitration(frames_[at]) == rank) {
            frames_[at] = frame;
            return Send::replaced;
        }
        while (at < frames_.size() && arbitration(frames_[at]) == rank) ++at;
        if (!frames_.push(frame)) return Send::refused_full;
        for (std::size_t i = frames_.size() - 1; i > at; --i) frames_[i] = frames_[i - 1];
        frames_[at] = frame;
        return Send::queued;
    }
    [[nodiscard]] constexpr const Frame* front() const noexcept TAPPET_REALTIME {
        return frames_.empty() ? nullptr : frames_.begin();
    }
    constexpr void pop() noexcept TAPPET_REALTIME {
        if (frames_.empty()) return;
        for (std::size_t i = 1; i < frames_.size(); ++i) frames_[i - 1] = frames_[i];
        --frames_.used;
    }
    /// Drops the frames made before `oldest`; says how many.
    constexpr std::size_t drop_older(Time oldest) noexcept TAPPET_REALTIME {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            if (frames_[i].stamp < oldest) continue;
            frames_[kept] = frames_[i];
            ++kept;
        }
        const std::size_t dropped = frames_.size() - kept;
        frames_.used = kept;
        return dropped;
    }
    constexpr std::size_t purge() noexcept TAPPET_REALTIME {
        const std::size_t dropped = frames_.size();
        frames_.clear();
        return dropped;
    }
    [[nodiscard]] constexpr std::size_t size() const noexcept TAPPET_REALTIME { return frames_.size(); }

private:
    Bounded<Frame, capacity> frames_{};
};

} // namespace tappet::can

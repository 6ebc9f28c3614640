// Frames queued for sending: bounded, in the order of arbitration, and old ones are detected.
#pragma once

#include "drivers/can/device.hpp"

#include <array>
#include <cstddef>
#include <utility>

namespace tappet::can {

/// Real-time: every call takes at most `capacity` steps. A frame does not move in memory; only its place in
/// the order changes.
class TransmitQueue {
public:
    static constexpr std::size_t capacity = 64;

    constexpr TransmitQueue() noexcept {
        for (std::size_t i = 0; i < capacity; ++i) order_[i].slot = static_cast<std::uint8_t>(i);
    }
    constexpr Send push(const Frame& frame, Keep keep) noexcept TAPPET_REALTIME {
        const std::uint32_t rank = keep == Keep::last ? behind_all : arbitration(frame);
        std::size_t at = 0;
        while (at < size_ && order_[at].rank < rank) ++at;
        if (keep == Keep::latest && at < size_ && order_[at].rank == rank) {
            put(frame, rank, order_[at]);
            return Send::replaced;
        }
        while (at < size_ && order_[at].rank == rank) ++at;
        if (size_ == capacity) return Send::refused_full;
        Waiting added = order_[size_];
        put(frame, rank, added);
        for (std::size_t i = size_++; i > at; --i) order_[i] = order_[i - 1];
        order_[at] = added;
        return Send::queued;
    }
    [[nodiscard]] constexpr const Frame* front() const noexcept TAPPET_REALTIME {
        return size_ == 0 ? nullptr : &frames_[order_[0].slot];
    }
    constexpr void pop() noexcept TAPPET_REALTIME {
        if (size_ == 0) return;
        const Waiting gone = order_[0];
        --size_;
        for (std::size_t i = 0; i < size_; ++i) order_[i] = order_[i + 1];
        order_[size_] = gone;
    }
    /// Drops the frames made before `oldest`; returns how many.
    constexpr std::size_t drop_older(Time oldest) noexcept TAPPET_REALTIME {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            if (order_[i].made < oldest) continue;
            if (kept != i) std::swap(order_[kept], order_[i]);
            ++kept;
        }
        const std::size_t dropped = size_ - kept;
        size_ = kept;
        return dropped;
    }
    constexpr std::size_t purge() noexcept TAPPET_REALTIME {
        const std::size_t dropped = size_;
        size_ = 0;
        return dropped;
    }
    [[nodiscard]] constexpr std::size_t size() const noexcept TAPPET_REALTIME { return size_; }

private:
    static constexpr std::uint32_t behind_all = ~std::uint32_t{0};
    struct Waiting {
        Time made{};
        std::uint32_t rank = 0;
        std::uint8_t slot = 0;
    };
    constexpr void put(const Frame& frame, std::uint32_t rank, Waiting& waiting) noexcept TAPPET_REALTIME {
        frames_[waiting.slot] = frame;
        waiting.made = rank == behind_all ? never : frame.stamp;
        waiting.rank = rank;
    }

    std::array<Frame, capacity> frames_{};
    std::array<Waiting, capacity> order_{}; // behind the first size_: the free slots
    std::size_t size_ = 0;
};

} // namespace tappet::can

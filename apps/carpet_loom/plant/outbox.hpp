// A queue of outgoing items: frames and edges until they are fetched.
#pragma once

#include "kernel/base/realtime.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tappet::loom {

/// A ring buffer. When it is full, the oldest item is lost and counted.
template <class T, std::size_t N> class Outbox {
public:
    constexpr void push(const T& item) noexcept TAPPET_REALTIME {
        if (used_ == N) {
            first_ = (first_ + 1) % N;
            --used_;
            ++lost_;
        }
        items_[(first_ + used_) % N] = item;
        ++used_;
    }
    [[nodiscard]] constexpr bool pop(T& item) noexcept TAPPET_REALTIME {
        if (used_ == 0) return false;
        item = items_[first_];
        first_ = (first_ + 1) % N;
        --used_;
        return true;
    }
    [[nodiscard]] constexpr bool empty() const noexcept TAPPET_REALTIME { return used_ == 0; }
    [[nodiscard]] constexpr std::uint64_t lost() const noexcept TAPPET_REALTIME { return lost_; }

private:
    std::array<T, N> items_{};
    std::size_t first_ = 0;
    std::size_t used_ = 0;
    std::uint64_t lost_ = 0;
};

} // namespace tappet::loom

// The queue between two components of one activity: a ring of plain values without atomics, because no other
// thread uses it (thesis 4.4: the buffer, both ends in one thread).
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/exchange/ring.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>

namespace tappet {

/// As Ring, with both sides in one thread. Any capacity from 1.
template <Exchangeable T>
class LocalRing {
public:
    static constexpr std::size_t alignment = alignof(T);
    [[nodiscard]] static constexpr std::size_t bytes_for(std::size_t capacity) noexcept {
        return capacity * sizeof(T);
    }

    /// `storage`: bytes_for(capacity) bytes at `alignment`; must outlive the ring. Not real-time.
    LocalRing(std::byte* storage, std::size_t capacity, Overflow overflow) noexcept
        : capacity_{capacity}, overflow_{overflow} {
        for (std::size_t i = 0; i < capacity; ++i) {
            T* cell = ::new (static_cast<void*>(storage + i * sizeof(T))) T{};
            if (i == 0) cells_ = cell;
        }
    }
    LocalRing(const LocalRing&) = delete;
    LocalRing& operator=(const LocalRing&) = delete;

    /// Adds a value; one copy. Returns false when the ring is full and refuses it. Real-time.
    [[nodiscard]] bool push(const T& value) noexcept TAPPET_REALTIME {
        if (used_ == capacity_) {
            ++lost_;
            if (overflow_ == Overflow::reject) return false;
            first_ = after(first_);
            --used_;
        }
        const std::size_t to_end = capacity_ - first_;
        cells_[used_ < to_end ? first_ + used_ : used_ - to_end] = value;
        ++used_;
        high_water_ = std::max(high_water_, used_);
        return true;
    }
    /// Takes the oldest value; one copy. False: the ring is empty, `into` is unchanged. Real-time.
    [[nodiscard]] bool pop(T& into) noexcept TAPPET_REALTIME {
        if (used_ == 0) return false;
        into = cells_[first_];
        first_ = after(first_);
        --used_;
        return true;
    }
    [[nodiscard]] std::size_t size() const noexcept TAPPET_REALTIME { return used_; }
    [[nodiscard]] bool empty() const noexcept TAPPET_REALTIME { return used_ == 0; }
    [[nodiscard]] std::size_t capacity() const noexcept TAPPET_REALTIME { return capacity_; }
    /// Returns the largest number of values that were ever inside.
    [[nodiscard]] std::size_t high_water() const noexcept TAPPET_REALTIME { return high_water_; }
    /// Returns the number of pushed values that will never be popped, by either policy.
    [[nodiscard]] std::uint64_t lost() const noexcept TAPPET_REALTIME { return lost_; }

private:
    [[nodiscard]] std::size_t after(std::size_t cell) const noexcept TAPPET_REALTIME {
        return cell + 1 == capacity_ ? 0 : cell + 1;
    }

    T* cells_ = nullptr;
    std::size_t capacity_;
    Overflow overflow_;
    std::size_t first_ = 0;
    std::size_t used_ = 0;
    std::size_t high_water_ = 0;
    std::uint64_t lost_ = 0;
};

} // namespace tappet

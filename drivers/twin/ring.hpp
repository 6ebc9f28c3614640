// A ring between two threads of the host world: a twin's replacement for a kernel's socket or event queue.
#pragma once

#include "kernel/base/realtime.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tappet::twin {

/// One writer, one reader, wait-free: both calls take a fixed number of steps (Lamport, 1983).
template <class T, std::size_t N> class Ring {
    static_assert(N > 0 && (N & (N - 1)) == 0, "the free-running indices wrap only with a power of two");

public:
    /// Returns where the writer fills in the next item, which add() then publishes; null when it is full.
    [[nodiscard]] T* room() noexcept TAPPET_REALTIME {
        const std::uint32_t end = end_.load(std::memory_order_relaxed);
        return end - begin_.load(std::memory_order_acquire) == N ? nullptr : &items_[end % N];
    }
    void add() noexcept TAPPET_REALTIME {
        end_.store(end_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    }
    /// Stores the item; returns false, and stores nothing, when it is full.
    [[nodiscard]] bool push(const T& item) noexcept TAPPET_REALTIME {
        T* const free = room();
        if (free == nullptr) return false;
        *free = item;
        add();
        return true;
    }
    /// Takes the next item; returns false, and leaves `item` unchanged, when it is empty.
    [[nodiscard]] bool pop(T& item) noexcept TAPPET_REALTIME {
        const std::uint32_t begin = begin_.load(std::memory_order_relaxed);
        if (begin == end_.load(std::memory_order_acquire)) return false;
        item = items_[begin % N];
        begin_.store(begin + 1, std::memory_order_release);
        return true;
    }
    /// Removes the reader's next item, seen by front().
    void drop() noexcept TAPPET_REALTIME {
        begin_.store(begin_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    }
    /// Returns the reader's next item, or null; valid until the reader's next pop().
    [[nodiscard]] const T* front() const noexcept TAPPET_REALTIME {
        const std::uint32_t begin = begin_.load(std::memory_order_relaxed);
        return begin == end_.load(std::memory_order_acquire) ? nullptr : &items_[begin % N];
    }
    [[nodiscard]] std::size_t size() const noexcept TAPPET_REALTIME {
        return end_.load(std::memory_order_acquire) - begin_.load(std::memory_order_acquire);
    }

private:
    std::array<T, N> items_{};
    alignas(64) std::atomic<std::uint32_t> begin_{0};
    alignas(64) std::atomic<std::uint32_t> end_{0};
};

} // namespace tappet::twin

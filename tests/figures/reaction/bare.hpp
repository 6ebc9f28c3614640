// The same without a framework, as one would write it in C: a thread that sleeps until the next period, and a
// thread that sleeps on a futex until a value is there.
#pragma once

#include "kernel/base/realtime.hpp"
#include "tests/figures/measure/ticks.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include <pthread.h>

namespace tappet::figures::reaction {

/// The lateness of the starts of that many cycles in a row.
class TickBlock {
public:
    static constexpr std::size_t capacity = 100;

    /// One thread adds ...
    void add(std::int64_t late_ns) noexcept TAPPET_REALTIME {
        const std::size_t at = count_.load(std::memory_order_relaxed);
        if (at >= capacity) return;
        late_ns_[at] = late_ns;
        count_.store(at + 1, std::memory_order_release);
    }
    /// ... another waits until it is full, reads and empties it.
    [[nodiscard]] bool full() const noexcept { return count_.load(std::memory_order_acquire) >= capacity; }
    void clear() noexcept { count_.store(0, std::memory_order_release); }
    [[nodiscard]] const std::array<std::int64_t, capacity>& late_ns() const noexcept { return late_ns_; }

private:
    std::array<std::int64_t, capacity> late_ns_{};
    std::atomic<std::size_t> count_{0};
};

/// The time at which the last value reached its receiver.
class Arrival {
public:
    void note(std::uint64_t value) noexcept TAPPET_REALTIME {
        at_ = ticks();
        value_.store(value, std::memory_order_release);
    }
    /// Called by the sender after it sent `value` at `begin`. Returns the ticks until arrival; 0: it did not
    /// arrive within a millisecond or so. Then it gives a receiver on another processor time to fall asleep
    /// again.
    std::uint64_t wait_for(std::uint64_t value, std::uint64_t begin, bool is_far) const noexcept
        TAPPET_REALTIME {
        constexpr std::uint64_t patience = 3'000'000, falling_asleep = 60'000; // ticks
        while (value_.load(std::memory_order_acquire) != value)
            if (ticks() - begin > patience) return 0;
        const std::uint64_t took = at_ - begin;
        if (is_far) {
            const std::uint64_t since = ticks();
            while (ticks() - since < falling_asleep) {
            }
        }
        return took;
    }

private:
    alignas(128) std::atomic<std::uint64_t> value_{0};
    std::uint64_t at_ = 0;
};

/// A thread of its own.
class BareThread {
public:
    /// The refusal; empty: it runs.
    const char* start(int processor, int priority, void* (*body)(void*), void* context) noexcept;
    void join() noexcept;
    ~BareThread() { join(); }

private:
    pthread_t thread_{};
    bool runs_ = false;
};

/// A word and a futex, with nothing else between sender and receiver.
class BareReceiver {
public:
    const char* start(int processor, int priority) noexcept;
    void end() noexcept;
    /// One sender; `value` is not 0.
    void post(std::uint64_t value) noexcept TAPPET_REALTIME;
    [[nodiscard]] const Arrival& arrival() const noexcept { return arrival_; }

private:
    static void* run(void* self) noexcept;
    alignas(128) std::atomic<std::uint32_t> posted_{0};
    std::uint64_t value_ = 0;
    Arrival arrival_{};
    std::atomic<bool> ends_{false};
    BareThread thread_{};
};

/// cyclictest's loop: sleeps until an absolute time, reads the clock, adds the period.
class BareTicker {
public:
    const char* start(int processor, int priority, std::int64_t period_ns) noexcept;
    void end() noexcept;
    /// Fills the block once more; the measuring thread waits for block().full().
    void go() noexcept;
    TickBlock& block() noexcept { return block_; }

private:
    static void* run(void* self) noexcept;
    void wake() noexcept;
    TickBlock block_{};
    std::int64_t period_ns_ = 0;
    std::atomic<std::uint32_t> asked_{0};
    std::atomic<bool> ends_{false};
    BareThread thread_{};
};

} // namespace tappet::figures::reaction

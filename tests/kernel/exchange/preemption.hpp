// Two sides of an exchange under a deterministic schedule that the test chooses. A switch is possible before
// each atomic access: whole operations of one side run in the middle of one of the other, or both alternate
// at random.
#pragma once

#include "kernel/base/random.hpp"
#include "kernel/base/realtime.hpp"

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace tappet {

/// One core, the other side with higher priority: `intruder` runs once at access number `at` of the side
/// under test.
class Preemption {
public:
    static Preemption& here() {
        static thread_local Preemption one;
        return one;
    }
    /// Runs `operation`, interrupted before its access `at` (from 0). Returns the number of its accesses.
    template <class Operation>
    std::size_t run(std::size_t at, std::function<void()> intruder, Operation&& operation) {
        return run_always(
            [at, intruder = std::move(intruder)](std::size_t access) {
                if (access == at) intruder();
            },
            std::forward<Operation>(operation));
    }
    /// Runs `operation`, calling `intruder` with each access' number before it.
    template <class Operation>
    std::size_t run_always(std::function<void(std::size_t)> intruder, Operation&& operation) {
        intruder_ = std::move(intruder);
        accesses_ = 0;
        armed_ = true;
        operation();
        armed_ = false;
        return accesses_;
    }
    void access() {
        if (!armed_) return;
        armed_ = false; // the intruder itself is not interrupted
        intruder_(accesses_);
        ++accesses_;
        armed_ = true;
    }

private:
    std::function<void(std::size_t)> intruder_;
    std::size_t accesses_ = 0;
    bool armed_ = false;
};

/// Two cores: both sides advance access by access, in an order that follows from the seed alone. Each side is
/// a thread, but only one at a time runs.
class Interleaving {
public:
    void run(std::uint64_t seed, const std::function<void()>& first, const std::function<void()>& second) {
        random_ = Random{seed};
        steps_per_turn_ = 1 + random_.below(12);
        finished_ = {false, false};
        const auto begins = static_cast<std::size_t>(random_.below(2));
        std::thread one([&] { take_part(0, first); });
        std::thread two([&] { take_part(1, second); });
        turn_[begins].release();
        one.join();
        two.join();
    }
    static void access() {
        if (current_ == nullptr || !current_->random_.one_in(current_->steps_per_turn_)) return;
        current_->hand_over();
    }

private:
    void take_part(std::size_t side, const std::function<void()>& operations) {
        turn_[side].acquire();
        current_ = this;
        side_ = side;
        operations();
        current_ = nullptr;
        finished_[side] = true;
        if (!finished_[1 - side]) turn_[1 - side].release();
    }
    void hand_over() {
        if (finished_[1 - side_]) return;
        turn_[1 - side_].release();
        turn_[side_].acquire();
    }

    /// Not std::binary_semaphore: it yields before it sleeps, which on a busy host lasts as long as all other
    /// threads run.
    class Turn {
    public:
        void acquire() {
            std::unique_lock lock{mutex_};
            begins_.wait(lock, [this] { return std::exchange(has_begun_, false); });
        }
        void release() {
            const std::scoped_lock lock{mutex_};
            has_begun_ = true;
            begins_.notify_one();
        }

    private:
        std::mutex mutex_;
        std::condition_variable begins_;
        bool has_begun_ = false;
    };

    static inline thread_local Interleaving* current_ = nullptr;
    static inline thread_local std::size_t side_ = 0;
    Random random_{0};
    std::uint64_t steps_per_turn_ = 1;
    std::array<Turn, 2> turn_{};
    std::array<bool, 2> finished_{};
};

/// Replaces std::atomic.
template <class T> class Preemptible {
public:
    constexpr Preemptible() = default;
    T load(std::memory_order /*order*/) const noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's schedule", Preemption::here().access(); Interleaving::access());
        return value_;
    }
    void store(T value, std::memory_order /*order*/) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's schedule", Preemption::here().access(); Interleaving::access());
        value_ = value;
    }

private:
    T value_{};
};

/// The same for values accessed as two words at once.
template <class T> class PreemptiblePair : public Preemptible<T> {
public:
    static void before_pair() noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's schedule", Preemption::here().access(); Interleaving::access());
    }
};

} // namespace tappet

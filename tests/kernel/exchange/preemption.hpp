// Two sides of an exchange on one core, without threads: between any two atomic accesses of one side the other may
// run some whole operations, as a thread of higher priority would. Deterministic, so that every point can be tried.
#pragma once

#include "kernel/base/realtime.hpp"

#include <atomic>
#include <cstddef>
#include <functional>
#include <utility>

namespace tappet {

/// The one schedule being tried: at the access with number `at` of the side under test, `intruder` runs once.
class Preemption {
public:
    static Preemption& here() {
        static Preemption one;
        return one;
    }
    /// Runs `operation`, interrupted before its access `at` (from 0). Returns how many accesses it made.
    template <class Operation>
    std::size_t run(std::size_t at, std::function<void()> intruder, Operation&& operation) {
        return run_always([at, intruder = std::move(intruder)](std::size_t access) {
            if (access == at) intruder();
        }, std::forward<Operation>(operation));
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

/// Stands where std::atomic does.
template <class T>
class Preemptible {
public:
    constexpr Preemptible() = default;
    T load(std::memory_order /*order*/) const noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's schedule", Preemption::here().access());
        return value_;
    }
    void store(T value, std::memory_order /*order*/) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("a test's schedule", Preemption::here().access());
        value_ = value;
    }

private:
    T value_{};
};

} // namespace tappet

// Measures an operation between activities alone, and while another core does the opposite one without a
// pause. The figures are for reading: a box under load says nothing about absolute times.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <sched.h>
#include <thread>
#include <vector>

namespace tappet {

using Nanoseconds = std::vector<std::uint32_t>;

inline constexpr std::size_t samples = 100'000;

/// Binds the thread to the nth processor that the process may use; with only one processor the sides
/// alternate.
inline void stay_on(std::size_t nth) {
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
    std::size_t left = nth % static_cast<std::size_t>(std::max(1, CPU_COUNT(&allowed)));
    for (std::size_t cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
        if (!CPU_ISSET(cpu, &allowed) || left-- != 0) continue;
        cpu_set_t one;
        CPU_ZERO(&one);
        CPU_SET(cpu, &one);
        static_cast<void>(sched_setaffinity(0, sizeof one, &one));
        return;
    }
}

/// Counts only calls that did their whole work, not those refused at once.
inline Nanoseconds measure(const std::function<bool()>& operation, const std::function<void()>& before_each) {
    using Clock = std::chrono::steady_clock;
    Nanoseconds took;
    took.reserve(samples);
    for (std::size_t tried = 0; took.size() < samples && tried < 50 * samples; ++tried) {
        before_each();
        const auto begin = Clock::now();
        const bool whole = operation();
        const auto end = Clock::now();
        if (whole) took.push_back(static_cast<std::uint32_t>(std::chrono::nanoseconds(end - begin).count()));
    }
    std::ranges::sort(took);
    return took;
}

inline std::uint32_t at_quantile(const Nanoseconds& sorted, double part) {
    if (sorted.empty()) return 0;
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
}

class Contention : public testing::Test {
protected:
    void SetUp() override {
        if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "two cores are needed to meet on";
    }

    /// Measures `operation` alone, then while `other` runs on another core. Returns how often `other` ran
    /// meanwhile.
    static std::uint64_t show(const char* name, const std::function<bool()>& operation,
                              const std::function<bool()>& other) {
        Nanoseconds alone;
        Nanoseconds contended;
        std::uint64_t met = 0;
        // In separate threads: the processor they stay on must not affect the next test.
        std::thread{[&] {
            stay_on(0);
            alone = measure(operation, [&] { static_cast<void>(other()); });
        }}.join();
        std::atomic<bool> over{false};
        std::atomic<std::uint64_t> rounds{0};
        std::thread opponent{[&] {
            stay_on(1);
            while (!over.load(std::memory_order_relaxed)) {
                static_cast<void>(other());
                rounds.store(rounds.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
            }
        }};
        std::thread{[&] {
            stay_on(0);
            while (rounds.load() == 0) std::this_thread::yield();
            const std::uint64_t before = rounds.load();
            // On a busy box the other side may have to wait for its core.
            for (int pass = 0; pass < 100 && met < 1'000; ++pass) {
                contended = measure(operation, [] {});
                met = rounds.load() - before;
            }
        }}.join();
        over = true;
        opponent.join();
        const Nanoseconds clock = measure([] { return true; }, [] {});
        std::printf("%-24s alone: median %5u ns, p99.9 %6u ns; contended: median %5u ns, p99.9 %6u ns; the "
                    "other side "
                    "%7llu times; the clock's own median %u ns\n",
                    name, at_quantile(alone, 0.5), at_quantile(alone, 0.999), at_quantile(contended, 0.5),
                    at_quantile(contended, 0.999), static_cast<unsigned long long>(met),
                    at_quantile(clock, 0.5));
        return met;
    }
};

} // namespace tappet

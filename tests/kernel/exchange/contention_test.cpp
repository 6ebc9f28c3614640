// How long each operation between activities takes while another core does the opposite one without a pause,
// beside the same operation undisturbed (thesis 4.4: bounded in time). Figures to read: a box under load says
// nothing about absolute times, so none is asserted; that both sides really met is.
#include "kernel/exchange/data_object.hpp"
#include "kernel/exchange/mailbox.hpp"
#include "kernel/exchange/ring.hpp"

#include "tests/kernel/exchange/stress.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <sched.h>
#include <thread>
#include <vector>

namespace {

using namespace tappet;
using Nanoseconds = std::vector<std::uint32_t>;

constexpr std::size_t samples = 100'000;

/// The thread stays on the nth of the processors that the process may use; without two of them the sides take
/// turns.
void stay_on(std::size_t nth) {
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

/// Of the calls that did their whole work, not of those that were refused at once.
Nanoseconds measure(const std::function<bool()>& operation, const std::function<void()>& before_each) {
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

std::uint32_t at(const Nanoseconds& sorted, double part) {
    if (sorted.empty()) return 0;
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
}

class Contention : public testing::Test {
protected:
    void SetUp() override {
        if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "two cores are needed to meet on";
    }

    /// Measures `operation` alone, then while `other` runs on another core. Returns how often that one ran
    /// meanwhile.
    static std::uint64_t show(const char* name, const std::function<bool()>& operation,
                              const std::function<bool()>& other) {
        Nanoseconds alone;
        Nanoseconds contended;
        std::uint64_t met = 0;
        // In threads of their own: where they stay is not where the next test begins.
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
            // On a busy box the other side may not get its core at once.
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
                    name, at(alone, 0.5), at(alone, 0.999), at(contended, 0.5), at(contended, 0.999),
                    static_cast<unsigned long long>(met), at(clock, 0.5));
        return met;
    }
};

TEST_F(Contention, of_a_data_object) {
    auto object = std::make_unique<DataObject<Sealed<160>>>();
    std::uint64_t number = 0;
    std::uint64_t generation = 0;
    Sealed<160> value{};
    const auto write = [&] {
        object->write(Sealed<160>::of(++number));
        return true;
    };
    const auto read = [&] {
        generation = 0; // so that there is a value to copy although nobody writes
        return object->read(value, generation);
    };
    EXPECT_GT(show("data object, write", write, read), 0u);
    EXPECT_GT(show("data object, read", read, write), 0u);
}

template <std::size_t Bytes> struct Storage {
    alignas(128) std::array<std::byte, Bytes> bytes;
};

TEST_F(Contention, of_a_ring) {
    using Queue = Ring<Sealed<160>>;
    auto storage = std::make_unique<Storage<Queue::bytes_for(16)>>();
    for (const Overflow overflow : {Overflow::reject, Overflow::drop_oldest}) {
        Queue ring{storage->bytes.data(), 16, overflow};
        Sealed<160> in = Sealed<160>::of(1);
        Sealed<160> out{};
        const auto push = [&] { return ring.push(in); };
        const auto pop = [&] { return ring.pop(out); };
        const bool drops = overflow == Overflow::drop_oldest;
        EXPECT_GT(show(drops ? "ring that drops, push" : "ring that rejects, push", push, pop), 0u);
        EXPECT_GT(show(drops ? "ring that drops, pop" : "ring that rejects, pop", pop, push), 0u);
    }
}

TEST_F(Contention, of_an_inbox) {
    auto storage = std::make_unique<std::array<Storage<Mailbox::bytes_for(8)>, 2>>();
    std::array<Mailbox, 2> mailboxes;
    for (std::size_t i = 0; i < 2; ++i) mailboxes[i].place((*storage)[i].bytes.data(), 8, Overflow::reject);
    Inbox inbox{mailboxes};
    const Message message{};
    const auto post = [&] { return inbox.post(0, message); };
    const auto serve = [&] { return inbox.run_all() != 0; };
    EXPECT_GT(show("inbox, post", post, serve), 0u);
    EXPECT_GT(show("inbox, serve all", serve, post), 0u);
}

} // namespace

// Each sample is one hand-over, stamped by the counter that both cores share. The kinds take turns in rounds.
#include "tests/figures/floors/two_threads.hpp"

#include "tests/figures/measure/ticks.hpp"
#include "tests/figures/measure/undisturbed.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include <linux/futex.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tappet::figures {

namespace {

/// Two lines apart, so that the prefetcher of adjacent lines does not join them.
struct alignas(128) Line {
    std::atomic<std::uint64_t> word{0};
};
constexpr std::size_t lines_touched = 64;

struct Shared {
    Line ball, answer;
    std::array<Line, lines_touched * 2> lines; ///< every second one is touched
};
Shared shared;

void wait_for(const std::atomic<std::uint64_t>& word, std::uint64_t value) {
    while (word.load(std::memory_order_acquire) != value) {
    }
}

/// One round of round trips: the ball goes out, the answer comes back.
void round_trips(std::size_t times, Samples& samples) {
    shared.ball.word = shared.answer.word = 0;
    std::atomic<bool> ready{false};
    std::thread other{[&] {
        const Undisturbed quiet{1};
        ready = true;
        for (std::uint64_t i = 1; i <= times; ++i) {
            wait_for(shared.ball.word, i);
            shared.answer.word.store(i, std::memory_order_release);
        }
    }};
    while (!ready) sched_yield();
    const double reading = ticks_of_reading();
    for (std::uint64_t i = 1; i <= times; ++i) {
        const std::uint64_t first = ticks();
        shared.ball.word.store(i, std::memory_order_release);
        wait_for(shared.answer.word, i);
        samples.add(std::max(0.0, static_cast<double>(ticks() - first) - reading) * ns_per_tick());
    }
    other.join();
}

/// One round of first touches: the other core writes many lines, this one reads each once, in an order that
/// no prefetcher can predict.
void first_touches(std::size_t times, Samples& samples) {
    shared.ball.word = shared.answer.word = 0;
    std::atomic<bool> ready{false};
    const std::size_t rounds = times / lines_touched + 1;
    std::thread other{[&] {
        const Undisturbed quiet{1};
        ready = true;
        for (std::uint64_t i = 1; i <= rounds; ++i) {
            wait_for(shared.ball.word, i);
            for (std::size_t n = 0; n < lines_touched; ++n)
                shared.lines[n * 2].word.store(i, std::memory_order_relaxed);
            shared.answer.word.store(i, std::memory_order_release);
        }
    }};
    while (!ready) sched_yield();
    const double reading = ticks_of_reading();
    for (std::uint64_t i = 1; i <= rounds; ++i) {
        shared.ball.word.store(i, std::memory_order_release);
        wait_for(shared.answer.word, i);
        for (std::size_t n = 0; n < lines_touched; ++n) {
            const std::size_t which = (n * 37 + i) % lines_touched; // 37 and 64 have no common divisor
            const std::uint64_t first = ticks();
            std::uint64_t value = shared.lines[which * 2].word.load(std::memory_order_relaxed);
            keep(value);
            samples.add(std::max(0.0, static_cast<double>(ticks() - first) - reading) * ns_per_tick());
        }
    }
    other.join();
}

std::atomic<std::uint32_t> gate{0};
void wait_futex() {
    while (gate.exchange(0, std::memory_order_acquire) == 0)
        syscall(SYS_futex, &gate, FUTEX_WAIT_PRIVATE, 0, nullptr, nullptr, 0);
}
void wake_futex() {
    gate.store(1, std::memory_order_release);
    syscall(SYS_futex, &gate, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}
int descriptor = -1;
void wait_eventfd() {
    std::uint64_t value = 0;
    static_cast<void>(!read(descriptor, &value, sizeof value));
}
void wake_eventfd() {
    const std::uint64_t one = 1;
    static_cast<void>(!write(descriptor, &one, sizeof one));
}

/// One round of wakes: from before the call that wakes to the sleeper's next statement. The sleeper has the
/// higher priority, so that on one core it runs at once.
void wakes(std::size_t times, int processor, void (*wait)(), void (*wake)(), Samples& samples) {
    std::atomic<std::uint64_t> woken{0};
    std::atomic<bool> ready{false};
    std::thread sleeper{[&] {
        const Undisturbed quiet{processor};
        sched_param parameters{};
        parameters.sched_priority = Undisturbed::priority + 1;
        static_cast<void>(pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters));
        ready = true;
        for (std::size_t i = 0; i < times; ++i) {
            wait();
            woken.store(ticks(), std::memory_order_release);
        }
    }};
    const auto until_it_sleeps = [] { std::this_thread::sleep_for(std::chrono::microseconds{60}); };
    while (!ready) until_it_sleeps();
    for (std::size_t i = 0; i < times; ++i) {
        until_it_sleeps();
        woken = 0;
        const std::uint64_t first = ticks();
        wake();
        std::uint64_t last = 0;
        while ((last = woken.load(std::memory_order_acquire)) == 0) {
        }
        samples.add(static_cast<double>(last - first) * ns_per_tick());
    }
    sleeper.join();
}

struct Kind {
    const char* name;
    void (*round)(std::size_t times, Samples& samples);
};
constexpr std::array lines{Kind{"round trip of a line", &round_trips},
                           Kind{"first touch of a line that the other core wrote", &first_touches}};
constexpr std::array sleepers{
    Kind{"futex, same core", [](std::size_t n, Samples& s) { wakes(n, 0, &wait_futex, &wake_futex, s); }},
    Kind{"eventfd, same core",
         [](std::size_t n, Samples& s) { wakes(n, 0, &wait_eventfd, &wake_eventfd, s); }},
    Kind{"futex, idle other core",
         [](std::size_t n, Samples& s) { wakes(n, 1, &wait_futex, &wake_futex, s); }},
    Kind{"eventfd, idle other core",
         [](std::size_t n, Samples& s) { wakes(n, 1, &wait_eventfd, &wake_eventfd, s); }},
};

template <std::size_t count>
void measure(Figure figure, const std::array<Kind, count>& kinds, std::size_t samples, const Options& options,
             Result& result) {
    if (!options.wants(figure.id)) return;
    constexpr int rounds = 5;
    const auto of_round = std::max<std::size_t>(
        20, static_cast<std::size_t>(static_cast<double>(samples) * options.scale() / rounds));
    std::array<Samples, count> all;
    const Undisturbed quiet{0};
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t which = (i + static_cast<std::size_t>(round)) % count;
            kinds[which].round(of_round, all[which]);
            std::this_thread::sleep_for(std::chrono::milliseconds{5}); // real-time threads rest
        }
    for (std::size_t i = 0; i < count; ++i)
        figure.rows.push_back({kinds[i].name, Standing::floor, all[i].summary()});
    result.figures.push_back(std::move(figure));
}

} // namespace

void measure_two_threads(const Options& options, Result& result) {
    if (std::thread::hardware_concurrency() < 2) {
        result.notes.emplace_back("this machine has one processor: nothing was handed over between two");
        return;
    }
    static_cast<void>(ns_per_tick());
    descriptor = eventfd(0, EFD_CLOEXEC);
    measure({"floors.line", "a cache line between two cores", "ns", "",
             "one hand-over; both threads at SCHED_FIFO"},
            lines, 20000, options, result);
    measure({"floors.wake", "waking a thread that sleeps", "ns", "",
             "one wake, from before the call to the sleeper's next line; SCHED_FIFO, latency lock held"},
            sleepers, 1500, options, result);
    close(descriptor);
}

} // namespace tappet::figures

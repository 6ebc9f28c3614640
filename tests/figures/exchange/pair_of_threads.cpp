// Starts the two threads together and compares their clocks.
#include "tests/figures/exchange/pair_of_threads.hpp"

#include "tests/figures/measure/undisturbed.hpp"

#include <chrono>
#include <thread>

namespace tappet::figures {

std::string meet(const std::function<void()>& giver, const std::function<void()>& taker) {
    static_cast<void>(ticks_of_reading()); // measured before any thread waits
    static_cast<void>(ns_per_tick());
    std::string refused;
    std::atomic<bool> ready{false}, go{false};
    std::thread other{[&] {
        const Undisturbed quiet{1};
        refused = quiet.refused();
        ready = true;
        while (!go.load(std::memory_order_acquire)) {
        }
        taker();
    }};
    // Before this thread binds itself to its processor, it waits: the other one may have started there.
    while (!ready) std::this_thread::sleep_for(std::chrono::microseconds{50});
    const std::uint64_t first = ticks();
    {
        const Undisturbed quiet{0};
        refused += quiet.refused();
        go.store(true, std::memory_order_release);
        giver();
    }
    other.join();
    rest_after(took_ns(first, ticks()));
    return refused;
}

namespace {

/// Half of each round trip, and the apparent lead of the answering thread's clock over the asking one's.
struct RoundTrips {
    Samples half_ticks{}, ahead_ticks{};
};

RoundTrips round_trips(std::size_t rounds, bool second_asks) {
    Line<std::uint64_t> there, back;
    Moments sent(rounds + 1), met(rounds + 1), returned(rounds + 1);
    const auto asks = [&] {
        for (std::size_t k = 1; k <= rounds; ++k) {
            sent[k] = ticks();
            there.value.store(k, std::memory_order_release);
            while (back.value.load(std::memory_order_acquire) != k) {
            }
            returned[k] = ticks();
        }
    };
    const auto answers = [&] {
        for (std::size_t k = 1; k <= rounds; ++k) {
            while (there.value.load(std::memory_order_acquire) != k) {
            }
            met[k] = ticks();
            back.value.store(k, std::memory_order_release);
        }
    };
    second_asks ? static_cast<void>(meet(answers, asks)) : static_cast<void>(meet(asks, answers));
    RoundTrips found;
    for (std::size_t k = 1; k <= rounds; ++k) {
        const double half = static_cast<double>(returned[k] - sent[k]) / 2;
        found.half_ticks.add(half - ticks_of_reading());
        found.ahead_ticks.add(static_cast<double>(met[k]) - static_cast<double>(sent[k]) - half);
    }
    return found;
}

} // namespace

Clocks compare_clocks(std::size_t rounds) {
    // An asymmetry of the roles cancels; an asymmetry of the clocks stays.
    const RoundTrips first = round_trips(rounds, false), second = round_trips(rounds, true);
    Clocks clocks;
    clocks.ahead_ticks = (first.ahead_ticks.median() - second.ahead_ticks.median()) / 2;
    for (const RoundTrips* each : {&first, &second})
        for (const double half : each->half_ticks.values()) clocks.one_way_ns.add(half * ns_per_tick());
    return clocks;
}

} // namespace tappet::figures

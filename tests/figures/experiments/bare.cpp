// A periodic loop on clock_nanosleep.
#include "tests/figures/experiments/run.hpp"

#include "kernel/machine/instance/instance.hpp"
#include "kernel/os/latency.hpp"
#include "kernel/os/memory.hpp"
#include "kernel/os/thread.hpp"
#include "tests/figures/measure/ticks.hpp"

#include <memory>

#include <time.h>

namespace tappet::experiments {

namespace {

struct Loop {
    Duration period{};
    std::uint64_t turns = 0;
    std::uint64_t ticks_of_stamps = 0;
    std::span<Execution> record{};
    std::uint64_t misses = 0;
    alignas(4096) std::array<std::byte, 64 * 1024> stack{};

    static void live(void* self) noexcept { static_cast<Loop*>(self)->repeat(); }
    void repeat() noexcept {
        timespec next{};
        clock_gettime(CLOCK_MONOTONIC, &next);
        for (Execution& now : record) {
            next.tv_nsec += period.count();
            for (; next.tv_nsec >= 1'000'000'000; next.tv_nsec -= 1'000'000'000) ++next.tv_sec;
            clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
            now.begin = figures::ticks();
            turn(turns);
            const std::uint64_t passed = figures::ticks() - now.begin;
            now.busy = static_cast<std::uint32_t>(passed > ticks_of_stamps ? passed - ticks_of_stamps : 0);
            timespec end{};
            clock_gettime(CLOCK_MONOTONIC, &end);
            misses +=
                Duration{(end.tv_sec - next.tv_sec) * 1'000'000'000 + end.tv_nsec - next.tv_nsec} > period;
        }
    }
};

/// Period and load of an application's task "high", as in its table.
std::pair<Duration, Duration> highest_of(const Application& application) {
    const AcceptedMachine machine = application.machine();
    os::Clock clock{os::Clock::Kind::virtual_time};
    const auto instance = std::make_unique<MachineInstance>(machine, clock);
    static_cast<void>(instance->configure({}));
    const std::size_t c = find_component(machine.table, "high");
    return {machine.table.activities[machine.index.activity[c]].period,
            instance->find<Task>("high")->load.get()};
}

} // namespace

std::string run_bare(const Application& application, const Circumstances& circumstances, double seconds,
                     TaskResult& into) {
    const auto [period, load] = highest_of(application);
    const Duration whole{static_cast<std::int64_t>(seconds * 1e9)};
    const Duration warming = warming_of(whole);
    std::vector<Execution> record(static_cast<std::size_t>((whole + warming) / period) + 2);
    const auto loop = std::make_unique<Loop>();
    loop->period = period;
    loop->turns = turns_for(load, circumstances.turns_per_ns);
    loop->ticks_of_stamps = circumstances.ticks_of_stamps;
    loop->record = record;
    static_cast<void>(os::lock_memory()); // as arming does; a refusal affects both alike
    const auto latency = os::hold_cpu_dma_latency();
    const os::ThreadPlan plan{"bare",    one_processor.highest_priority, -1, loop->stack, &Loop::live,
                              loop.get()};
    os::Thread thread;
    if (const auto started = thread.start(plan); !started) return std::string{started.error().view()};
    thread.join();
    into.misses += loop->misses;
    into.name = "high";
    into.period_us = to_seconds(period) * 1e6;
    into.load_us = to_seconds(load) * 1e6;
    into.real_time = true;
    evaluate(record, Setting::none, circumstances.ns_per_tick,
             static_cast<std::uint64_t>(static_cast<double>(warming.count()) / circumstances.ns_per_tick),
             into);
    return {};
}

} // namespace tappet::experiments

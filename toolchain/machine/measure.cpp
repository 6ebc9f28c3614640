// SPDX-License-Identifier: Apache-2.0
// Measures with threads that wake, threads that load, and the kernel's own tracer.
#include "toolchain/machine/measure.hpp"

#include "kernel/machine/check/time.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/latency.hpp"
#include "kernel/os/memory.hpp"
#include "kernel/os/sleep.hpp"
#include "kernel/os/system_file.hpp"
#include "kernel/os/terminal.hpp"
#include "kernel/os/thread.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <new>

#include <ctime>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <unistd.h>

namespace tappet {

namespace {

constexpr std::size_t most_processors = 16;
constexpr Duration wakes_every = 1ms;
constexpr const char* tracing = "/sys/kernel/tracing";
/// Longer than one reading of the clock, shorter than a gap that would break any deadline here.
constexpr Duration hardware_gap = 10us;

struct Load {
    std::array<std::byte, 4 * 1024 * 1024> from, to;
};

/// Measures the wake-up latency of one processor.
struct Probe {
    alignas(64) std::array<std::byte, 64 * 1024> stack{}, load_stack{};
    os::Thread sleeper{}, loader{};
    Time until{};
    const std::atomic<bool>* loaded = nullptr;
    Load* memory = nullptr; ///< shared: it does not matter that loads of several processors write it
    Duration latest{-1};
    std::uint64_t wakes = 0;

    static void wake(void* self) noexcept {
        Probe& own = *static_cast<Probe*>(self);
        Time due = os::Clock::monotonic() + wakes_every;
        for (; due < own.until && own.loaded->load(std::memory_order_relaxed); due += wakes_every) {
            const std::int64_t ns = to_ns(due);
            const timespec at{ns / 1'000'000'000, ns % 1'000'000'000};
            while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {
            }
            const Duration late = os::Clock::monotonic() - due;
            own.latest = std::max(own.latest, late);
            ++own.wakes;
            if (late > wakes_every) due += late / wakes_every * wakes_every;
        }
    }
    static void load(void* self) noexcept {
        const Probe& own = *static_cast<Probe*>(self);
        while (own.loaded->load(std::memory_order_relaxed))
            std::memcpy(own.memory->to.data(), own.memory->from.data(), own.memory->to.size());
    }
};

/// Allocates pages from the system, not in the firmware's static memory, which is locked while a machine
/// runs. Freed when the process ends.
template <class T>
T* pages_for() {
    void* const at = ::mmap(nullptr, sizeof(T), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return at == MAP_FAILED ? nullptr : new (at) T{};
}

bool put(const char* name, std::string_view text) {
    const Sentence path{std::string_view{tracing}, "/", std::string_view{name}};
    const int file = ::open(path.characters, O_WRONLY | O_CLOEXEC);
    const bool well =
        file >= 0 && ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    if (file >= 0) ::close(file);
    return well;
}

/// Measures gaps by hardware: the kernel stops everything else on a processor and reads the clock.
class HardwareLatency {
public:
    HardwareLatency() {
        ::mount("tracefs", tracing, "tracefs", 0, nullptr); // it may be mounted already
        is_on_ = put("current_tracer", "hwlat") &&
                 put("tracing_thresh", Sentence{hardware_gap / 1us}.view()) &&
                 put("tracing_max_latency", "0") && put("tracing_on", "1");
    }
    ~HardwareLatency() { static_cast<void>(put("current_tracer", "nop")); }
    HardwareLatency(const HardwareLatency&) = delete;
    HardwareLatency& operator=(const HardwareLatency&) = delete;

    [[nodiscard]] Sentence tell() const {
        if (!is_on_) return Sentence{"hardware latency: not measured, this kernel has no tracer hwlat"};
        const os::SystemFile seen{"", Sentence{std::string_view{tracing}, "/tracing_max_latency"}};
        return Sentence{"hardware latency: ", seen.text() == "0" ? "none over 10" : seen.text(), " us"};
    }

private:
    bool is_on_ = false;
};

/// The claims that the compiler accepted.
struct Claims {
    std::array<int, max_activities> processors{};
    std::array<std::int64_t, max_activities> worst_response_ns{};

    void take(const AcceptedMachine& machine) {
        const MachineView& table = machine.table;
        for (std::size_t a = 0; a < table.activities.size(); ++a)
            processors[a] = checks::processor_of(*machine.board, *machine.binding, table.activities[a].name);
        worst_response_ns =
            checks::worst_responses_ns(table, *machine.board, *machine.binding, machine.index);
    }
};

Sentence in_us(Duration time) { return Sentence{time.count() / 1000, " us"}; }
void say(const Sentence& line) { os::print(Sentence{line, "\n"}.view()); }

using Probes = std::array<Probe, most_processors>;
using Processors = std::array<bool, most_processors>;

/// Selects the processors of real-time activities. Returns false when one cannot be measured.
bool choose(const AcceptedMachine& machine, const Claims& claims, Processors& wanted) {
    for (std::size_t a = 0; a < machine.table.activities.size(); ++a) {
        if (!machine.table.activities[a].real_time) continue;
        const auto processor = static_cast<std::size_t>(claims.processors[a]);
        if (processor >= most_processors) {
            say(Sentence{"processor ", processor, " cannot be measured, only 0 to 15 can"});
            return false;
        }
        wanted[processor] = true;
    }
    return true;
}

/// Wakes and loads the processors for `time`. Returns false when a thread was refused.
bool measure(Probes& probes, const Processors& wanted, Load& memory, int priority, Duration time) {
    std::atomic<bool> loaded{true};
    const HardwareLatency hardware;
    const Time until = os::Clock::monotonic() + time;
    for (std::size_t p = 0; p < most_processors; ++p) {
        if (!wanted[p]) continue;
        Probe& probe = probes[p];
        probe.until = until;
        probe.loaded = &loaded;
        probe.memory = &memory;
        const auto load = probe.loader.start({.name = "load",
                                              .processor = static_cast<int>(p),
                                              .stack = probe.load_stack,
                                              .body = &Probe::load,
                                              .context = &probe});
        const auto sleep = probe.sleeper.start({.name = "wakes",
                                                .fifo_priority = priority,
                                                .processor = static_cast<int>(p),
                                                .stack = probe.stack,
                                                .body = &Probe::wake,
                                                .context = &probe});
        if (!load || !sleep) {
            say(!sleep ? sleep.error() : load.error());
            loaded = false;
            for (Probe& each : probes) each.sleeper.join(), each.loader.join(); // they use locals from here
            return false;
        }
    }
    for (Probe& probe : probes) probe.sleeper.join();
    loaded = false;
    for (Probe& probe : probes) probe.loader.join();
    say(hardware.tell());
    return true;
}

/// Judges whether each activity may begin as late as its processor woke.
bool judge(const AcceptedMachine& machine, const Claims& claims, const Probes& probes) {
    bool holds = true;
    for (std::size_t a = 0; a < machine.table.activities.size(); ++a) {
        const ActivityRow& row = machine.table.activities[a];
        if (!row.real_time) continue;
        const Duration room = row.deadline() - Duration{claims.worst_response_ns[a]};
        const Duration latest = probes[static_cast<std::size_t>(claims.processors[a])].latest;
        const bool fits = latest <= room;
        holds = holds && fits;
        say(Sentence{"activity ", row.name, ": may start ", in_us(room),
                     " late in addition to its worst response of ",
                     in_us(Duration{claims.worst_response_ns[a]}), fits ? ": holds" : ": DOES NOT HOLD"});
    }
    return holds;
}

} // namespace

int measure_box(const AcceptedMachine& machine, Duration time) {
    auto* const memory = pages_for<Load>();
    auto* const probes = pages_for<Probes>();
    auto* const claims = pages_for<Claims>();
    if (memory == nullptr || probes == nullptr || claims == nullptr) {
        say(Sentence{"not enough memory to measure; stop other programs"});
        return 2;
    }
    claims->take(machine);
    Processors wanted{};
    if (!choose(machine, *claims, wanted)) return 2;
    const auto awake = os::hold_cpu_dma_latency();
    if (!awake) say(awake.error());
    if (!measure(*probes, wanted, *memory, machine.board->highest_priority, time)) return 2;
    for (std::size_t p = 0; p < most_processors; ++p)
        if (wanted[p])
            say(Sentence{"processor ", p, ": woke at most ", in_us((*probes)[p].latest), " late, of ",
                         (*probes)[p].wakes, " times"});
    const bool holds = judge(machine, *claims, *probes);
    say(Sentence{holds ? "the box can hold the table's claims"
                       : "the box cannot hold the table's claims; use a faster box, or longer deadlines"});
    return holds ? 0 : 1;
}

} // namespace tappet

// The table of checks, one function each: properties that a box needs for a machine to keep its deadlines.
#include "kernel/os/arming.hpp"

#include "kernel/os/heap.hpp"
#include "kernel/os/latency.hpp"
#include "kernel/os/memory.hpp"
#include "kernel/os/system_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>

namespace tappet::os {

namespace {

using Verdict = SystemCheck::Verdict;

/// The kernels on which the bench measures the claims of the checks.
constexpr std::string_view kernels = "6.1 6.12";

/// The release of the running kernel: "6.12.9-rt", of the series "6.12".
class Release {
public:
    explicit Release(std::string_view root) noexcept
        : file_{root, Sentence{"/proc/sys/kernel/osrelease"}},
          major_{number_after(file_.text(), "", 10)},
          minor_{number_after(file_.text(), ".", 10)} {}

    [[nodiscard]] std::string_view text() const noexcept {
        return file_.readable ? file_.text() : "of unknown release";
    }
    [[nodiscard]] bool is_of(std::string_view series) const noexcept {
        return number_after(series, "", 10) == major_ && number_after(series, ".", 10) == minor_;
    }
    /// Returns whether the kernel has a fair server; a release that cannot be read counts as one that has.
    [[nodiscard]] bool has_fair_server() const noexcept {
        return !major_ || !minor_ || *major_ > 6 || (*major_ == 6 && *minor_ >= 12);
    }

private:
    SystemFile file_;
    std::optional<std::uint64_t> major_, minor_;
};

bool was_measured(const SystemCheck& check, const Release& release) noexcept {
    std::string_view rest = check.measured_on;
    while (!rest.empty()) {
        const std::string_view series = rest.substr(0, rest.find(' '));
        if (release.is_of(series)) return true;
        rest.remove_prefix(std::min(rest.size(), series.size() + 1));
    }
    return false;
}

// Kernels with the RT patches show it in /sys; since 6.12 the mainline's own PREEMPT_RT is in the version
// only.
Verdict look_at_kernel(const ArmingOptions& options, const ProcessFacts&) noexcept {
    const SystemFile flag{options.root, Sentence{"/sys/kernel/realtime"}};
    const SystemFile version{options.root, Sentence{"/proc/sys/kernel/version"}};
    const Sentence name{"kernel ", Release{options.root}.text()};
    if (flag.text() == "1" || version.text().find(" PREEMPT_RT ") != std::string_view::npos)
        return {true, Sentence{name, " is PREEMPT_RT"}};
    return {false, Sentence{name, " is not PREEMPT_RT"}};
}

Verdict look_at_clock_source(const ArmingOptions& options, const ProcessFacts&) noexcept {
    const Sentence path{"/sys/devices/system/clocksource/clocksource0/current_clocksource"};
    const SystemFile file{options.root, path};
    if (!file.readable) return {false, Sentence{path, " cannot be read"}};
    const bool good = std::find(options.clock_sources.begin(), options.clock_sources.end(), file.text()) !=
                      options.clock_sources.end();
    Sentence text{"the clock source is ", file.text()};
    if (good) return {true, text};
    text.add("; the board accepts");
    for (const std::string_view name : options.clock_sources) text.add(" ").add(name);
    return {false, text};
}

Verdict look_at_clock_resolution(const ArmingOptions&, const ProcessFacts& facts) noexcept {
    return {facts.clock_resolution_ns == 1,
            Sentence{"CLOCK_MONOTONIC has a resolution of ", facts.clock_resolution_ns, " ns"}};
}

Verdict look_at_priority(const ArmingOptions& options, const ProcessFacts& facts) noexcept {
    if (facts.fifo_error == 0)
        return {true, Sentence{"SCHED_FIFO priority ", options.highest_priority, " can be set"}};
    return {false, Sentence{"SCHED_FIFO priority ", options.highest_priority, " cannot be set (",
                            std::strerror(facts.fifo_error), ")"}};
}

// Since Linux 6.12 threads without a real-time priority get 50 ms of each second, whatever
// sched_rt_runtime_us says. This is the fair server, and only debugfs shows and stops it. Measuring it here
// would delay each start of the machine by more than a second; the bench measures it, once for each kernel.
Verdict look_at_throttling(const ArmingOptions& options, const ProcessFacts&) noexcept {
    const SystemFile file{options.root, Sentence{"/proc/sys/kernel/sched_rt_runtime_us"}};
    if (!file.readable) return {false, Sentence{"/proc/sys/kernel/sched_rt_runtime_us cannot be read"}};
    if (file.text() != "-1")
        return {false, Sentence{"real-time threads are stopped after ", file.text(), " us of each period"}};
    const Release release{options.root};
    for (const int processor : options.processors) {
        const Sentence path{"/sys/kernel/debug/sched/fair_server/cpu", processor, "/runtime"};
        const SystemFile runtime{options.root, path};
        if (runtime.readable && runtime.text() != "0")
            return {false, Sentence{"real-time threads on processor ", processor, " lose ", runtime.text(),
                                    " ns of each period to the fair server"}};
        if (!runtime.readable && release.has_fair_server())
            return {false,
                    Sentence{"kernel ", release.text(), " has a fair server, which may stop real-time ",
                             "threads on processor ", processor, ": ", path, " cannot be read (",
                             std::strerror(runtime.error), ")"}};
    }
    return {true, Sentence{"real-time threads are not throttled"}};
}

Verdict look_at_latency(const ArmingOptions&, const ProcessFacts& facts) noexcept {
    if (facts.latency_held) return {true, Sentence{"/dev/cpu_dma_latency is held at 0"}};
    return {false, Sentence{"/dev/cpu_dma_latency is not held: processors fall into deep sleep"}};
}

Verdict look_at_lock_limit(const ArmingOptions& options, const ProcessFacts& facts) noexcept {
    constexpr std::uint64_t may_lock = std::uint64_t{1} << 14; // CAP_IPC_LOCK, linux/capability.h
    const SystemFile status{options.root, Sentence{"/proc/self/status"}};
    const auto capabilities = number_after(status.text(), "CapEff:", 16).value_or(0);
    if ((capabilities & may_lock) != 0) return {true, Sentence{"the process has CAP_IPC_LOCK"}};
    if (facts.lockable_bytes == ~std::uint64_t{0}) return {true, Sentence{"RLIMIT_MEMLOCK is unlimited"}};
    return {false, Sentence{"the process may lock ", facts.lockable_bytes / 1024, " kB only"}};
}

Verdict look_at_lock(const ArmingOptions& options, const ProcessFacts& facts) noexcept {
    const SystemFile status{options.root, Sentence{"/proc/self/status"}};
    const auto locked_kb = number_after(status.text(), "VmLck:", 10).value_or(0);
    if (!facts.memory_locked) return {false, Sentence{"memory is not locked: pages may be taken away"}};
    if (locked_kb == 0) return {false, Sentence{"memory was locked, but the kernel shows 0 kB of it"}};
    return {true, Sentence{locked_kb, " kB of memory are locked"}};
}

Verdict look_at_swap(const ArmingOptions& options, const ProcessFacts&) noexcept {
    const SystemFile file{options.root, Sentence{"/proc/swaps"}};
    // A kernel built without swap has no such file.
    if (!file.readable && file.error != ENOENT)
        return {false, Sentence{"/proc/swaps cannot be read (", std::strerror(file.error), ")"}};
    const std::string_view lines = file.text(); // a heading, and a line for each swap
    const std::size_t second = lines.find('\n');
    if (second == std::string_view::npos) return {true, Sentence{"no swap is in use"}};
    const std::string_view line = lines.substr(second + 1);
    return {false, Sentence{"swap is in use on ", line.substr(0, line.find_first_of(" \t\n"))}};
}

Verdict look_at_processors(const ArmingOptions& options, const ProcessFacts&) noexcept {
    const SystemFile online{options.root, Sentence{"/sys/devices/system/cpu/online"}};
    if (!online.readable) return {false, Sentence{"/sys/devices/system/cpu/online cannot be read"}};
    Sentence missing;
    for (const int processor : options.processors)
        if (!list_has(online.text(), processor)) missing.add(" ").add(processor);
    if (missing.empty()) return {true, Sentence{"the plan's processors are online (", online.text(), ")"}};
    return {false, Sentence{"the plan names processors that are not online:", missing, "; online are ",
                            online.text()}};
}

Verdict look_at_governor(const ArmingOptions& options, const ProcessFacts&) noexcept {
    bool scaled = false;
    for (const int processor : options.processors) {
        const Sentence path{"/sys/devices/system/cpu/cpu", processor, "/cpufreq/scaling_governor"};
        const SystemFile file{options.root, path};
        if (!file.readable && file.error == ENOENT) continue;
        if (!file.readable)
            return {false, Sentence{path, " cannot be read (", std::strerror(file.error), ")"}};
        scaled = true;
        if (file.text() != "performance")
            return {false, Sentence{"processor ", processor, " has the frequency governor ", file.text()}};
    }
    return {true, Sentence{scaled ? "the plan's processors keep their highest frequency"
                                  : "the plan's processors have no frequency scaling here"}};
}

Verdict look_at_timer_slack(const ArmingOptions&, const ProcessFacts& facts) noexcept {
    return {facts.timer_slack_ns <= 1,
            Sentence{"timers of threads without SCHED_FIFO may be ", facts.timer_slack_ns, " ns late"}};
}

Verdict look_at_heap(const ArmingOptions&, const ProcessFacts& facts) noexcept {
    if (!facts.heap_sealed) return {false, Sentence{"the heap is not sealed"}};
    if (facts.seal_counts) return {true, Sentence{"the heap is sealed"}};
    return {false, Sentence{heap::sanitizer_owns_malloc
                                ? "a sanitizer owns malloc: the seal sees nothing"
                                : "the program's malloc is not the arena's: the seal sees nothing"}};
}

Verdict look_at_trial(const ArmingOptions& options, const ProcessFacts&) noexcept {
    const Release release{options.root};
    Sentence missing;
    bool measured = false;
    for (const SystemCheck& check : system_checks()) {
        if (check.measured_on.empty()) continue;
        if (was_measured(check, release))
            measured = true;
        else
            missing.add(" ").add(check.name);
    }
    if (missing.empty()) return {true, Sentence{"the checks were tried on this kernel"}};
    if (measured) return {false, Sentence{"not tried on kernel ", release.text(), " are", missing}};
    return {false,
            Sentence{"no check was tried on kernel ", release.text(), "; the kernels tried are ", kernels}};
}

// clang-format off
constexpr SystemCheck checks[] = {
    {"realtime-kernel", "/sys/kernel/realtime, the kernel's version",
     "work of interrupts does not hold up a real-time thread", kernels, Severity::refused,
     "boot a kernel built with PREEMPT_RT", look_at_kernel},
    {"clock-source", "current_clocksource",
     "the clock is read from a counter of the processor", "", Severity::refused,
     "boot with clocksource=tsc (and tsc=reliable where the firmware's is), or let the board accept this one", look_at_clock_source},
    {"clock-resolution", "CLOCK_MONOTONIC",
     "a thread sleeps to the microsecond, not to the tick", kernels, Severity::refused,
     "use a kernel with high-resolution timers (CONFIG_HIGH_RES_TIMERS) and boot without highres=off", look_at_clock_resolution},
    {"fifo-priority", "SCHED_FIFO on this thread",
     "a real-time thread runs before every other", kernels, Severity::refused,
     "run as root, grant CAP_SYS_NICE or raise RLIMIT_RTPRIO", look_at_priority},
    {"rt-throttling", "sched_rt_runtime_us, fair_server",
     "nobody takes the processor from a real-time thread that goes on working", kernels, Severity::refused,
     "write -1 to /proc/sys/kernel/sched_rt_runtime_us; since Linux 6.12 mount debugfs at /sys/kernel/debug and write 0 to "
     "sched/fair_server/cpuN/runtime there, too, which Secure Boot forbids: boot Linux 6.1 with it", look_at_throttling},
    {"cpu-dma-latency", "/dev/cpu_dma_latency",
     "processors stay out of deep sleep", "", Severity::refused,
     "let the process write to /dev/cpu_dma_latency: run as root or change its owner", look_at_latency},
    {"memory-lockable", "RLIMIT_MEMLOCK, CAP_IPC_LOCK",
     "the process can lock all its memory", kernels, Severity::refused,
     "run as root, grant CAP_IPC_LOCK or set RLIMIT_MEMLOCK to unlimited", look_at_lock_limit},
    {"memory-locked", "mlockall, VmLck",
     "memory is there before it is touched", kernels, Severity::refused,
     "cure memory-lockable and see that the box has the memory", look_at_lock},
    {"swap", "/proc/swaps",
     "no page is written to a disk", "", Severity::refused,
     "run swapoff -a and take swap out of /etc/fstab", look_at_swap},
    {"processors", "/sys/devices/system/cpu/online",
     "threads run on the processors of the plan", kernels, Severity::refused,
     "correct the processor plan of the board, or bring the processors online", look_at_processors},
    {"cpu-governor", "scaling_governor",
     "processors keep their highest frequency", "", Severity::refused,
     "write performance to each scaling_governor, or boot with cpufreq.default_governor=performance", look_at_governor},
    {"timer-slack", "PR_GET_TIMERSLACK",
     "timers of threads without SCHED_FIFO are not put off", kernels, Severity::warning,
     "call minimise_timer_slack before the threads start", look_at_timer_slack},
    {"heap-sealed", "the heap's state",
     "an allocation is seen", kernels, Severity::refused,
     "link tappet_sealed_heap, build without a sanitizer and seal before the checks", look_at_heap},
    {"kernel-tried", "the kernel's release",
     "the bench measured the checks on this kernel", "", Severity::warning,
     "boot one of the kernels tried, or try this one: tests/bench/probe/arming.cpp", look_at_trial},
};
// clang-format on
static_assert(std::size(checks) * 2 < ArmingReport::max_findings,
              "other layers have room for as many findings");

} // namespace

std::span<const SystemCheck> system_checks() noexcept { return checks; }

ProcessFacts observe_process(int highest_priority) noexcept {
    ProcessFacts facts;
    timespec resolution{};
    if (clock_getres(CLOCK_MONOTONIC, &resolution) == 0)
        facts.clock_resolution_ns = resolution.tv_sec * 1'000'000'000 + resolution.tv_nsec;

    // Setting SCHED_FIFO resets the thread's timer slack: it is read before, and restored after.
    facts.timer_slack_ns = prctl(PR_GET_TIMERSLACK);
    int policy = SCHED_OTHER;
    sched_param before{};
    pthread_getschedparam(pthread_self(), &policy, &before);
    sched_param wanted{};
    wanted.sched_priority = highest_priority;
    facts.fifo_error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
    if (facts.fifo_error == 0) {
        pthread_setschedparam(pthread_self(), policy, &before);
        prctl(PR_SET_TIMERSLACK, static_cast<unsigned long>(facts.timer_slack_ns), 0UL, 0UL, 0UL);
    }

    rlimit limit{};
    if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0)
        facts.lockable_bytes = limit.rlim_cur == RLIM_INFINITY ? ~std::uint64_t{0} : limit.rlim_cur;
    facts.memory_locked = memory_is_locked();
    facts.latency_held = cpu_dma_latency_is_held();
    facts.heap_sealed = heap::state() == heap::State::sealed;
    facts.seal_counts = heap::seal_counts();
    return facts;
}

void check_system(ArmingReport& report, const ArmingOptions& options, const ProcessFacts& facts) noexcept {
    for (const SystemCheck& check : checks) {
        const Verdict verdict = check.look(options, facts);
        if (verdict.good)
            report.passed(check.name, verdict.finding);
        else if (check.severity == Severity::refused)
            report.fault(check.name, verdict.finding, Sentence{check.cure});
        else
            report.warning(check.name, verdict.finding, Sentence{check.cure});
    }
}

} // namespace tappet::os

// bench-arming: compares the checks of arming on this kernel with measurements of their claims, on the box as
// it boots and after each cure. It ends with 1 when a check passes while its claim does not hold, and when
// the table's rows for this kernel and the measurements differ. With the word "unfit" it examines a kernel
// that must not pass.
#include "kernel/os/arming.hpp"
#include "board/init/system.hpp"
#include "kernel/base/contract.hpp"
#include "kernel/os/heap.hpp"
#include "kernel/os/latency.hpp"
#include "kernel/os/memory.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include <csignal>
#include <sched.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

TAPPET_HEAP_ARENA(512 * 1024)

namespace tappet {
namespace {

constexpr int processor = 0;
constexpr int priority = 80;
constexpr std::int64_t us = 1'000, ms = 1'000'000;

std::int64_t now_ns() {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return time.tv_sec * 1'000 * ms + time.tv_nsec;
}

void sleep_until(std::int64_t due_ns) {
    const timespec due{due_ns / (1'000 * ms), due_ns % (1'000 * ms)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
}

bool set_policy(int policy) {
    sched_param parameter{};
    parameter.sched_priority = policy == SCHED_FIFO ? priority : 0;
    return sched_setscheduler(0, policy, &parameter) == 0;
}

/// A process without a real-time priority that never sleeps.
class Competitor {
public:
    Competitor() : pid_{fork()} {
        while (pid_ == 0) now_ns();
    }
    ~Competitor() {
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
    }
    Competitor(const Competitor&) = delete;
    Competitor& operator=(const Competitor&) = delete;

private:
    pid_t pid_;
};

struct Measured {
    bool holds;
    std::string what;
};

Measured at_most(std::int64_t measured_ns, std::int64_t limit_ns, const std::string& what) {
    return {measured_ns <= limit_ns, what + " " + std::to_string(measured_ns / us) + " us"};
}

/// The longest time during which a never-sleeping thread under SCHED_FIFO does not run.
std::int64_t largest_gap_ns(std::int64_t for_ns, std::int64_t enough_ns) {
    set_policy(SCHED_FIFO);
    std::int64_t largest = 0;
    const std::int64_t begin = now_ns();
    for (std::int64_t last = begin, now = begin; last - begin < for_ns && largest < enough_ns; last = now) {
        now = now_ns();
        largest = std::max(largest, now - last);
    }
    set_policy(SCHED_OTHER);
    return largest;
}

/// Longer than two of the periods in which a thread is stopped.
Measured measure_throttling() {
    const Competitor competitor;
    return at_most(largest_gap_ns(2'200 * ms, 20 * ms), 5 * ms, "a thread that spins is stopped for");
}

/// So many timers expire at once that handling them takes milliseconds.
Measured measure_interrupts() {
    constexpr int timers = 2'000;
    const rlimit many{timers + 100, timers + 100};
    setrlimit(RLIMIT_SIGPENDING, &many);
    sigset_t blocked;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGUSR1);
    sigprocmask(SIG_BLOCK, &blocked, nullptr);
    const std::int64_t due = now_ns() + 300 * ms;
    itimerspec once{};
    once.it_value = {due / (1'000 * ms), due % (1'000 * ms)};
    std::vector<timer_t> all;
    for (int i = 0; i < timers; ++i) {
        sigevent event{};
        event.sigev_notify = SIGEV_SIGNAL;
        event.sigev_signo = SIGUSR1;
        timer_t timer{};
        if (timer_create(CLOCK_MONOTONIC, &event, &timer) != 0) return {false, "no timer is left"};
        timer_settime(timer, TIMER_ABSTIME, &once, nullptr);
        all.push_back(timer);
    }
    if (now_ns() > due - 10 * ms) return {false, "the timers were late to be set"};
    sleep_until(due - 5 * ms);
    const std::int64_t gap = largest_gap_ns(50 * ms, 1'000 * ms);
    for (const timer_t timer : all) timer_delete(timer);
    return at_most(gap, 500 * us, std::to_string(timers) + " timers stop a real-time thread for");
}

/// The median, since the box has other work too.
std::int64_t late_ns(std::int64_t sleep_ns) {
    std::vector<std::int64_t> late;
    for (int i = 0; i < 51; ++i) {
        const std::int64_t due = now_ns() + sleep_ns;
        sleep_until(due);
        late.push_back(now_ns() - due);
    }
    std::ranges::sort(late);
    return late[late.size() / 2];
}

Measured measure_resolution() {
    set_policy(SCHED_FIFO);
    const std::int64_t late = late_ns(100 * us);
    set_policy(SCHED_OTHER);
    return at_most(late, 500 * us, "a sleep of 100 us is late by");
}

Measured measure_priority() {
    const Competitor competitor;
    if (!set_policy(SCHED_FIFO)) return {false, "the priority is refused"};
    const std::int64_t late = late_ns(1 * ms);
    set_policy(SCHED_OTHER);
    return at_most(late, 500 * us, "beside one that spins a real-time thread is late by");
}

Measured measure_lockable() {
    constexpr std::size_t bytes = 16 << 20;
    void* const piece = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    const bool locked = piece != MAP_FAILED && mlock(piece, bytes) == 0;
    munmap(piece, bytes);
    return {locked, std::string{"16 MB of memory "} + (locked ? "are locked" : "cannot be locked")};
}

Measured measure_lock() {
    constexpr std::size_t pages = 256;
    const std::size_t bytes = pages * os::page_bytes();
    void* const piece = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    rusage before{}, after{};
    getrusage(RUSAGE_SELF, &before);
    os::touch({static_cast<std::byte*>(piece), bytes});
    getrusage(RUSAGE_SELF, &after);
    munmap(piece, bytes);
    const long faults = after.ru_minflt - before.ru_minflt;
    return {faults == 0, "256 new pages take " + std::to_string(faults) + " page faults"};
}

Measured measure_processor(int wanted) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(wanted), &set);
    const bool runs = sched_setaffinity(0, sizeof set, &set) == 0 && sched_getcpu() == wanted;
    return {runs, "a thread " + std::string{runs ? "runs" : "cannot run"} + " on processor " +
                      std::to_string(wanted)};
}

Measured measure_slack() {
    return at_most(late_ns(1 * ms), 500 * us, "a thread without SCHED_FIFO wakes late by");
}

Measured measure_seal() {
    install_contract_handler([](const ContractViolation&) noexcept TAPPET_REALTIME {});
    const std::uint64_t before = os::heap::allocations_after_seal();
    void* piece = std::malloc(100);
    asm volatile("" : "+r"(piece) : : "memory");
    std::free(piece);
    const std::uint64_t seen = os::heap::allocations_after_seal() - before;
    return {seen == 1, "of one allocation " + std::to_string(seen) + " are seen"};
}

std::map<std::string_view, bool> measured; // by name of the check: it passed, and its claim held
int faults = 0;

void find_fault(const std::string& what) {
    std::printf("FAULT: %s\n", what.c_str());
    ++faults;
}

const os::SystemCheck& row_of(std::string_view name) {
    for (const os::SystemCheck& check : os::system_checks())
        if (check.name == name) return check;
    find_fault("no check is called " + std::string{name});
    std::exit(1);
}

/// `wanted` processor: that of the plan.
void compare(std::string_view name, const char* situation, const Measured& found, int wanted = processor) {
    const os::SystemCheck& check = row_of(name);
    const std::array plan{wanted};
    const os::ArmingOptions options{.processors = plan, .highest_priority = priority};
    const auto verdict = check.look(options, os::observe_process(priority));
    std::printf("%s, %s: %s: %s; measured: %s\n", check.name.data(), situation,
                verdict.good ? "passed" : "refused", verdict.finding.characters, found.what.c_str());
    if (verdict.good != found.holds)
        find_fault(std::string{name} +
                   (verdict.good ? " passes, and its claim does not hold: "
                                 : " does not pass, and its claim holds: ") +
                   std::string{check.claims});
    measured[check.name] |= verdict.good && found.holds;
    std::fflush(stdout);
}

/// Runs in a process without rights, like an unprivileged service.
void compare_without_rights() {
    std::fflush(stdout);
    const pid_t pid = fork();
    if (pid == 0) {
        const rlimit little{65536, 65536};
        setrlimit(RLIMIT_MEMLOCK, &little);
        if (setuid(1001) != 0) std::_Exit(1);
        faults = 0;
        compare("fifo-priority", "without rights", measure_priority());
        compare("memory-lockable", "without rights", measure_lockable());
        std::_Exit(faults);
    }
    int status = 0;
    waitpid(pid, &status, 0);
    if (status != 0) find_fault("the process without rights ended with faults");
}

void compare_throttling() {
    const auto compare_here = [](const char* situation) {
        compare("rt-throttling", situation, measure_throttling());
    };
    compare_here("as booted");
    init::write_text("/proc/sys/kernel/sched_rt_runtime_us", "-1");
    compare_here("without throttling");
    if (mount("debugfs", "/sys/kernel/debug", "debugfs", 0, nullptr) == 0)
        compare_here("with debugfs mounted");
    const auto stopped = init::stop_throttling();
    if (!stopped) find_fault(stopped.error());
    compare_here("as a box boots");
}

/// The part that only another boot changes.
void compare_kernel() {
    compare("realtime-kernel", "as booted", measure_interrupts());
    compare("clock-resolution", "as booted", measure_resolution());
}

void compare_rest() {
    compare_throttling();
    compare("fifo-priority", "as root", measure_priority());
    compare("memory-lockable", "as root", measure_lockable());
    compare_without_rights();
    compare("processors", "with one that is there", measure_processor(processor));
    compare("processors", "with one that is not there", measure_processor(63), 63);
    prctl(PR_SET_TIMERSLACK, 5 * ms);
    compare("timer-slack", "of 5 ms", measure_slack());
    os::minimise_timer_slack();
    compare("timer-slack", "minimised", measure_slack());
    compare("memory-locked", "not locked", measure_lock());
    if (const auto locked = os::lock_memory(); !locked) find_fault(std::string{locked.error().view()});
    compare("memory-locked", "locked", measure_lock());
    compare("heap-sealed", "open", measure_seal());
    os::heap::seal();
    const Measured sealed = measure_seal();
    os::heap::release();
    os::heap::seal(); // the output below allocates
    compare("heap-sealed", "sealed", sealed);
    os::heap::release();
}

/// On a kernel on which every check can pass, the table lists exactly the measured claims.
void compare_table() {
    const std::string release = init::read_line("/proc/sys/kernel/osrelease");
    const std::string series = release.substr(0, release.find('.', release.find('.') + 1));
    for (const os::SystemCheck& check : os::system_checks()) {
        const bool says =
            (" " + std::string{check.measured_on} + " ").find(" " + series + " ") != std::string::npos;
        if (says != measured[check.name])
            find_fault("the row of " + std::string{check.name} + (says ? " names" : " does not name") +
                       " kernel " + series + ", and here its claim was " +
                       (says ? "not measured to hold" : "measured to hold"));
    }
    compare("kernel-tried", "as booted", {faults == 0, "all of the above"});
}

} // namespace
} // namespace tappet

int main(int count, char** words) {
    tappet::compare_kernel();
    if (count < 2 || std::string_view{words[1]} != "unfit") {
        tappet::compare_rest();
        tappet::compare_table();
    }
    std::printf("bench-arming: %d faults\n", tappet::faults);
    return tappet::faults == 0 ? 0 : 1;
}

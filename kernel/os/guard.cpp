// SPDX-License-Identifier: Apache-2.0
// fork, a page of memory shared by both processes, and the parent's observation of its child.
#include "kernel/os/guard.hpp"

#include "kernel/os/clock.hpp"
#include "kernel/os/signals.hpp"
#include "kernel/os/sleep.hpp"
#include "kernel/os/terminal.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::os {

namespace {

bool write_to(const char* path, std::string_view text) noexcept {
    const int file = open(path, O_WRONLY | O_CLOEXEC);
    if (file < 0) return false;
    const bool written = write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    close(file);
    return written;
}

// A limit of 0 prevents core files; 1 also prevents core dumps to pipes, which would delay the end.
void dump_no_core() noexcept {
    const rlimit none{1, 1};
    setrlimit(RLIMIT_CORE, &none);
}

/// Returns whether data can be read, or a process has ended, within `time`.
bool comes_within(int descriptor, Duration time) noexcept {
    pollfd told{descriptor, POLLIN, 0};
    const timespec limit{static_cast<time_t>(time / 1s), static_cast<long>((time % 1s).count())};
    return ppoll(&told, 1, &limit, nullptr) > 0;
}

} // namespace

std::expected<Guard::Side, Sentence> Guard::split(int crash_patience_ms) noexcept {
    const auto refused = [](std::string_view what, std::string_view cure) {
        return std::unexpected(
            Sentence{"the machine has no guardian: ", what, " (", std::strerror(errno), "); ", cure});
    };
    void* shared =
        mmap(nullptr, sizeof(GuardBlock), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED)
        return refused("no memory that two processes share", "give the box more memory");
    crash_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    if (crash_ < 0) return refused("no eventfd", "raise the limit of open files");
    auto* block = new (shared) GuardBlock;
    pthread_mutexattr_t robust;
    pthread_mutexattr_init(&robust);
    pthread_mutexattr_setpshared(&robust, PTHREAD_PROCESS_SHARED);
    pthread_mutexattr_setrobust(&robust, PTHREAD_MUTEX_ROBUST);
    pthread_mutex_init(&block->machine_lives, &robust);
    guardian_ = getpid();
    // A parent that ignores the ends of children leaves that to its children: then nobody could wait for one.
    signal(SIGCHLD, SIG_DFL);
    // The guardian passes on signals that arrive in between.
    sigset_t all, before;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &before);
    const pid_t child = fork();
    if (child <= 0) sigprocmask(SIG_SETMASK, &before, nullptr);
    if (child < 0)
        return refused("no second process", "give the box more memory, or raise the limit of processes");
    block_ = block;
    if (child != 0) {
        machine_ = child;
        machine_descriptor_ = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
        if (machine_descriptor_ >= 0) return Side::guardian;
        auto refusal = refused("no descriptor of a process", "use Linux 5.3 or later");
        ::kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        block_ = nullptr;
        sigprocmask(SIG_SETMASK, &before, nullptr);
        return refusal;
    }
    pthread_mutex_lock(&block->machine_lives); // for ever
    // The end of the guardian requests the orderly stop, as every signal does; the supervisor then sees that
    // the guardian is gone.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    dump_no_core();
    on_crash(block->crash, crash_, crash_patience_ms);
    return Side::machine;
}

Sentence Guard::wait_for_guardian() noexcept {
    for (int waited = 0; waited < 1000 && !guardian_is_lost(); ++waited) {
        if (block_->is_ready.load(std::memory_order_acquire)) return {};
        if (block_->has_refused.load(std::memory_order_acquire)) return block_->refusal;
        sleep_for(1ms);
    }
    return Sentence{"the guardian did not come to be ready"};
}

void Guard::be_back_within(Duration time) noexcept {
    if (block_ != nullptr)
        block_->back_by_ns.store(to_ns(Clock::monotonic() + time), std::memory_order_release);
}

void Guard::let_activities_be_watched(bool watched) noexcept {
    if (block_ != nullptr) block_->activities_run.store(watched, std::memory_order_release);
}

void Guard::end(Outputs outputs, const Sentence& fault) noexcept {
    if (block_ == nullptr) return;
    block_->fault = fault;
    block_->ended_well.store(outputs == Outputs::safe, std::memory_order_release);
    block_->is_left.store(outputs == Outputs::unsafe, std::memory_order_release);
    block_->has_stopped.store(true, std::memory_order_release);
    // No code of the machine runs until the guardian has ended it.
    for (int waited = 0; outputs == Outputs::unsafe && waited < 1000 && !guardian_is_lost(); ++waited)
        sleep_for(1ms);
}

bool Guard::guardian_is_lost() noexcept {
    if (block_ == nullptr) return false;
    if (getppid() != guardian_) return true;
    const std::int64_t looked = block_->looked_ns.load(std::memory_order_acquire);
    const bool is_stale = looked != 0 && Clock::monotonic() - at_ns(looked) > guardian_within;
    stale_looks_ = is_stale ? stale_looks_ + 1 : 0;
    return stale_looks_ >= 3;
}

bool Guard::become_guardian(std::span<const int> kept) noexcept {
    const int all_kept[] = {0, 1, 2, machine_descriptor_, crash_};
    const auto keeps = [&](int file) {
        for (const int each : all_kept)
            if (file == each) return true;
        for (const int each : kept)
            if (file == each) return true;
        return false;
    };
    // Files that the machine opened would otherwise stay open after its end: a browser would wait at a socket
    // that nobody serves.
    for (int file = 3; file < 256; ++file)
        if (!keeps(file)) close(file);
    on_termination(nullptr);
    sigset_t all; // blocked since the split
    sigfillset(&all);
    signals_ = signalfd(-1, &all, SFD_NONBLOCK | SFD_CLOEXEC);
    never_wait();
    prctl(PR_SET_NAME, "guardian");
    prctl(PR_SET_TIMERSLACK, 1);
    block_->is_spared.store(write_to("/proc/self/oom_score_adj", "-1000"), std::memory_order_release);
    sched_param above{};
    above.sched_priority = sched_get_priority_max(SCHED_FIFO);
    return sched_setscheduler(0, SCHED_FIFO, &above) == 0;
}

void Guard::give_back(std::uintptr_t begin, std::uintptr_t end) noexcept {
    constexpr std::uintptr_t page = 4096;
    begin = (begin + page - 1) & ~(page - 1);
    end &= ~(page - 1);
    // If a range is mapped in part, the call fails for the rest, but gives that part back.
    if (begin < end) static_cast<void>(madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED));
}

// Not memory that may be touched later: the machine's memory is mapped in this process as well, but none of
// it is present here.
void Guard::stay_in_memory() noexcept {
    constexpr std::uintptr_t own_calls = 16 * 1024, most = 8 << 20;
    const auto here = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
    give_back(here - most, here - own_calls);
    static_cast<void>(mlockall(MCL_CURRENT | MCL_ONFAULT));
}

void Guard::refuse(const Sentence& why) noexcept {
    block_->refusal = why;
    block_->has_refused.store(true, std::memory_order_release);
}

Guard::Seen Guard::look(Duration time) noexcept {
    block_->looked_ns.store(to_ns(Clock::monotonic()), std::memory_order_release);
    pollfd told[] = {{machine_descriptor_, POLLIN, 0}, {crash_, POLLIN, 0}, {signals_, POLLIN, 0}};
    const timespec limit{static_cast<time_t>(time / 1s), static_cast<long>((time % 1s).count())};
    if (ppoll(told, 3, &limit, nullptr) > 0) {
        if (told[0].revents != 0) return await_end(0ms) ? Seen::end : Seen::nothing;
        if (told[1].revents != 0) return Seen::crash;
        signalfd_siginfo facts{};
        if (read(signals_, &facts, sizeof facts) == sizeof facts && facts.ssi_signo != SIGCHLD)
            send(static_cast<int>(facts.ssi_signo));
    }
    if (!is_owned_) is_owned_ = block_->back_by_ns.load(std::memory_order_acquire) != 0;
    // Its memory is freed before its descriptor reports the end, which takes some milliseconds.
    if (is_owned_ && pthread_mutex_trylock(&block_->machine_lives) == EOWNERDEAD) return Seen::dying;
    block_->looked_ns.store(to_ns(Clock::monotonic()), std::memory_order_release);
    return Seen::nothing;
}

void Guard::kill() const noexcept { send(SIGKILL); }

// By its descriptor: after a process has ended, another one may have its number.
void Guard::send(int signal) const noexcept {
    syscall(SYS_pidfd_send_signal, machine_descriptor_, signal, nullptr, 0);
}

bool Guard::try_apart(Duration time, void (*act)(void*), void* context) noexcept {
    const pid_t child = fork();
    if (child == 0) {
        dump_no_core();
        const sched_param none{};
        if (sched_setscheduler(0, SCHED_OTHER, &none) == 0) act(context);
        _exit(0);
    }
    if (child < 0) return false;
    const int descriptor = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
    const bool in_time = descriptor >= 0 && comes_within(descriptor, time);
    if (!in_time) ::kill(child, SIGKILL);
    // A process that waits in the kernel, for a disk, ends when the disk answers: perhaps never.
    if (!in_time && descriptor >= 0) static_cast<void>(comes_within(descriptor, 1s));
    if (descriptor >= 0) close(descriptor);
    int status = 0;
    return waitpid(child, &status, WNOHANG) == child && in_time && WIFEXITED(status);
}

bool Guard::await_end(Duration time) noexcept {
    if (has_ended_ || !comes_within(machine_descriptor_, time)) return has_ended_;
    has_ended_ = true;
    int status = 0;
    if (waitpid(machine_, &status, WNOHANG) != machine_) return true; // a tracer gets the exit status first
    exit_code_ = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    return true;
}

} // namespace tappet::os

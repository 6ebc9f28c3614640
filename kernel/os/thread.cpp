// Starts a pthread on the stack, processor and priority of its plan. A refusal names the cure.
#include "kernel/os/thread.hpp"

#include "kernel/os/clock.hpp"
#include "kernel/os/crash.hpp"
#include "kernel/os/memory.hpp"
#include "kernel/os/sleep.hpp"

#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>

namespace tappet::os {

namespace {

void* enter(void* context) noexcept {
    const auto& plan = *static_cast<const ThreadPlan*>(context);
    char name[16] = {};
    std::memcpy(name, plan.name.data(), std::min<std::size_t>(plan.name.size(), sizeof name - 1));
    pthread_setname_np(pthread_self(), name);
    take_crashes_on_own_stack(plan.stack);
    plan.body(plan.context);
    return nullptr;
}

// Signals that request the end are for the starter: no handler takes time from this thread's cycles, and none
// of its calls is interrupted. It receives signals of its own faults.
int block_signals(pthread_attr_t& attributes) noexcept {
    sigset_t blocked;
    sigfillset(&blocked);
    for (const int own : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGABRT, SIGSYS})
        sigdelset(&blocked, own);
    return pthread_attr_setsigmask_np(&attributes, &blocked);
}

Sentence refusal(const ThreadPlan& plan, int error) {
    Sentence text{"activity \"", plan.name, "\": the kernel refuses its thread (", std::strerror(error),
                  "): "};
    if (error == EPERM)
        text.add("run as root or grant CAP_SYS_NICE, or raise RLIMIT_RTPRIO");
    else if (error == EINVAL)
        text.add("processor ")
            .add(plan.processor)
            .add(" or the stack of ")
            .add(plan.stack.size())
            .add(" bytes does not exist here: correct the board's processor plan or the activity's stack");
    else
        text.add("free memory or threads on this box");
    return text;
}

} // namespace

std::expected<void, Sentence> Thread::start(const ThreadPlan& plan) {
    plan_ = plan; // the thread reads it, and some threads start within this call
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    int error =
        plan.stack.empty() ? 0 : pthread_attr_setstack(&attributes, plan.stack.data(), plan.stack.size());
    if (error == 0) {
        const bool is_inherited = plan.fifo_priority == ThreadPlan::as_its_starter;
        pthread_attr_setinheritsched(&attributes,
                                     is_inherited ? PTHREAD_INHERIT_SCHED : PTHREAD_EXPLICIT_SCHED);
        pthread_attr_setschedpolicy(&attributes, plan.fifo_priority > 0 ? SCHED_FIFO : SCHED_OTHER);
        sched_param parameter{};
        parameter.sched_priority = is_inherited ? 0 : plan.fifo_priority;
        pthread_attr_setschedparam(&attributes, &parameter);
        if (plan.processor >= 0) {
            cpu_set_t set;
            CPU_ZERO(&set);
            CPU_SET(static_cast<std::size_t>(plan.processor), &set);
            pthread_attr_setaffinity_np(&attributes, sizeof set, &set);
        }
        if (error == 0) error = block_signals(attributes);
        guard_ = stack_guard(plan.stack);
        if (error == 0 && !guard_.empty() && mprotect(guard_.data(), guard_.size(), PROT_NONE) != 0)
            error = errno;
        if (error == 0) error = pthread_create(&handle_, &attributes, enter, &plan_);
    }
    pthread_attr_destroy(&attributes);
    if (error != 0) {
        open_guard();
        return std::unexpected(refusal(plan, error));
    }
    started_ = true;
    return {};
}

void Thread::open_guard() noexcept {
    if (!guard_.empty()) mprotect(guard_.data(), guard_.size(), PROT_READ | PROT_WRITE);
    guard_ = {};
}

void Thread::join() noexcept {
    if (!started_) return;
    pthread_join(handle_, nullptr);
    open_guard();
    started_ = false;
}

// Its stack may be touched and painted for another thread: a machine whose thread hangs is of no other use.
void Thread::abandon() noexcept {
    if (!started_) return;
    pthread_detach(handle_);
    open_guard();
    started_ = false;
}

// Not pthread_timedjoin_np: it waits by the wall clock, which may be set meanwhile. Not pthread_clockjoin_np:
// the thread sanitizer does not know it, and reports all actions of the joined thread as races.
bool Thread::join_within(int milliseconds) noexcept {
    if (!started_) return true;
    for (const Time end = Clock::monotonic() + milliseconds * 1ms;
         pthread_tryjoin_np(handle_, nullptr) != 0;) {
        if (Clock::monotonic() >= end) return false;
        sleep_for(1ms);
    }
    open_guard();
    started_ = false;
    return true;
}

} // namespace tappet::os

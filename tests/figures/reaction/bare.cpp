// System calls and nothing else.
#include "tests/figures/reaction/bare.hpp"

#include <cstring>
#include <ctime>

#include <linux/futex.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tappet::figures::reaction {

namespace {

void futex_wait(std::atomic<std::uint32_t>& word, std::uint32_t while_it_is) noexcept {
    syscall(SYS_futex, &word, FUTEX_WAIT_PRIVATE, while_it_is, nullptr, nullptr, 0);
}
void futex_wake(std::atomic<std::uint32_t>& word) noexcept {
    syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

std::int64_t to_ns(const timespec& time) noexcept { return time.tv_sec * 1'000'000'000 + time.tv_nsec; }

} // namespace

const char* BareThread::start(int processor, int priority, void* (*body)(void*), void* context) noexcept {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(&attributes, SCHED_FIFO);
    sched_param parameters{};
    parameters.sched_priority = priority;
    pthread_attr_setschedparam(&attributes, &parameters);
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(processor), &set);
    pthread_attr_setaffinity_np(&attributes, sizeof set, &set);
    const int error = pthread_create(&thread_, &attributes, body, context);
    pthread_attr_destroy(&attributes);
    runs_ = error == 0;
    return runs_ ? "" : std::strerror(error);
}

void BareThread::join() noexcept {
    if (runs_) pthread_join(thread_, nullptr);
    runs_ = false;
}

const char* BareReceiver::start(int processor, int priority) noexcept {
    return thread_.start(processor, priority, &BareReceiver::run, this);
}

void BareReceiver::end() noexcept {
    ends_.store(true);
    post(1);
    thread_.join();
}

void BareReceiver::post(std::uint64_t value) noexcept TAPPET_REALTIME {
    value_ = value;
    posted_.store(1, std::memory_order_release);
    TAPPET_ESCAPE("what is measured here", futex_wake(posted_));
}

void* BareReceiver::run(void* self) noexcept {
    auto& at = *static_cast<BareReceiver*>(self);
    while (true) {
        while (at.posted_.load(std::memory_order_acquire) == 0) futex_wait(at.posted_, 0);
        at.posted_.store(0, std::memory_order_relaxed);
        if (at.ends_.load(std::memory_order_relaxed)) return nullptr;
        at.arrival_.note(at.value_);
    }
}

const char* BareTicker::start(int processor, int priority, std::int64_t period_ns) noexcept {
    period_ns_ = period_ns;
    return thread_.start(processor, priority, &BareTicker::run, this);
}

void BareTicker::wake() noexcept {
    asked_.store(1, std::memory_order_release);
    futex_wake(asked_);
}

void BareTicker::go() noexcept {
    block_.clear();
    wake();
}

void BareTicker::end() noexcept {
    ends_.store(true);
    wake();
    thread_.join();
}

void* BareTicker::run(void* self) noexcept {
    auto& at = *static_cast<BareTicker*>(self);
    while (true) {
        while (at.asked_.load(std::memory_order_acquire) == 0) futex_wait(at.asked_, 0);
        at.asked_.store(0, std::memory_order_relaxed);
        if (at.ends_.load(std::memory_order_relaxed)) return nullptr;
        timespec now{};
        clock_gettime(CLOCK_MONOTONIC, &now);
        std::int64_t next = to_ns(now);
        while (!at.block_.full()) {
            next += at.period_ns_;
            const timespec until{static_cast<time_t>(next / 1'000'000'000),
                                 static_cast<long>(next % 1'000'000'000)};
            clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
            clock_gettime(CLOCK_MONOTONIC, &now);
            at.block_.add(to_ns(now) - next);
            if (to_ns(now) > next + at.period_ns_) // as ours: lost periods are not made up for
                next += (to_ns(now) - next) / at.period_ns_ * at.period_ns_;
        }
    }
}

} // namespace tappet::figures::reaction

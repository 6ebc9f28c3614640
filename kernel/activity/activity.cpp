// The life of an activity's thread: start, cycles and stop of its engine, from one request to the next.
#include "kernel/activity/activity.hpp"

#include "kernel/os/memory.hpp"
#include "kernel/os/sleep.hpp"

#include <algorithm>

namespace tappet {

namespace {

thread_local Activity* current_activity = nullptr;

} // namespace

std::expected<void, Sentence> Activity::create(Engine& engine, const os::Clock& clock, int priority,
                                               int processor, std::span<std::byte> stack) {
    engine_ = &engine;
    clock_ = &clock;
    os::paint_stack(stack);
    plan_ = {engine.name(), priority, processor, stack, &Activity::enter, this};
    return thread_.start(plan_);
}

bool Activity::wait_for(State wanted, int milliseconds) const noexcept {
    for (const Time end = os::Clock::monotonic() + milliseconds * 1ms; state() < wanted;) {
        if (os::Clock::monotonic() >= end) return false;
        os::sleep_for(1ms);
    }
    return true;
}

void Activity::start() noexcept {
    stop_asked_.store(false, std::memory_order_relaxed);
    engine_stop_claimed_.store(false, std::memory_order_relaxed);
    state_.store(State::starting, std::memory_order_relaxed);
    released_.store(true, std::memory_order_release);
    engine_->waiter().wake();
}

void Activity::ask_to_stop(Time ends_by) noexcept {
    if (state() == State::inactive || state() == State::stopped) return;
    ends_by_ns_.store(to_ns(ends_by), std::memory_order_relaxed);
    stop_asked_.store(true, std::memory_order_release);
    engine_->waiter().wake();
}

bool Activity::is_stopped_within(int milliseconds) const noexcept {
    return state() == State::inactive || wait_for(State::stopped, milliseconds);
}

bool Activity::end(int milliseconds) noexcept {
    if (!thread_.running()) return true;
    ended_.store(true, std::memory_order_release);
    engine_->waiter().wake();
    return thread_.join_within(milliseconds + 1);
}

Activity* Activity::current() noexcept TAPPET_REALTIME {
    Activity* found = nullptr;
    TAPPET_ESCAPE("thread-local memory of the main program is there from the thread's start",
                  found = current_activity);
    return found;
}

void Activity::enter(void* self) noexcept { static_cast<Activity*>(self)->live(); }

void Activity::live() noexcept {
    current_activity = this;
    const RunsActivity here{engine_->plan().activity, engine_->now_address()};
    while (!ended_.load(std::memory_order_acquire)) {
        if (released_.load(std::memory_order_acquire)) {
            run_once();
        } else {
            engine_->waiter().wait_for_wake();
            if (stopped_its_engine_) engine_->reject_late();
        }
    }
}

void Activity::run_once() noexcept {
    engine_->start(clock_->now());
    const os::PageFaults before = os::page_faults_of_this_thread();
    state_.store(State::waiting, std::memory_order_release);
    cycles();
    end();
    const os::PageFaults here = os::page_faults_of_this_thread() - before;
    faults_.minor += here.minor;
    faults_.major += here.major;
    stopped_its_engine_ = claim_engine_stop();
    if (stopped_its_engine_) engine_->stop(clock_->now());
    released_.store(false, std::memory_order_relaxed);
    state_.store(State::stopped, std::memory_order_release);
}

bool Activity::sleep_until(Time time) noexcept TAPPET_REALTIME {
    engine_->sleeps_until(time);
    engine_->heed_devices_of_running();
    const bool woken = engine_->waiter().wait(time);
    if (!woken) engine_->stamps().renew(); // a stamp behind the clock would show the time as still ahead
    return woken;
}

void Activity::cycles() noexcept TAPPET_REALTIME {
    const EnginePart* const looping = engine_->looping();
    while (true) {
        if (looping != nullptr && is_running(looping->state) && keeps_running()) {
            state_.store(State::running, std::memory_order_relaxed);
            TAPPET_ESCAPE("this activity is not real-time", loop(*looping));
            state_.store(State::waiting, std::memory_order_relaxed);
        }
        const bool woken = keeps_running() && sleep_until(engine_->next_wake());
        if (!keeps_running()) return;
        state_.store(State::running, std::memory_order_relaxed);
        engine_->run(woken);
        state_.store(State::waiting, std::memory_order_relaxed);
    }
}

// Runs cycles until the behaviours have ended; none if asked so late that the supervisor may not wait.
void Activity::end() noexcept TAPPET_REALTIME {
    const Time until = at_ns(ends_by_ns_.load(std::memory_order_relaxed));
    if (clock_->now() >= until) return;
    engine_->begin_end(clock_->now(), until);
    while (!engine_->has_ended(clock_->now())) {
        const bool woken = sleep_until(std::min(engine_->next_wake(), engine_->ends_at()));
        engine_->run(woken);
    }
}

void Activity::loop(const EnginePart& part) {
    LoopControl control{{this,
                         [](void* self, Duration time) noexcept {
                             auto& at = *static_cast<Activity*>(self);
                             const Time until = std::min(at.clock_->now() + time, at.engine_->next_wake());
                             const bool woken = at.keeps_running() && at.sleep_until(until);
                             if (at.keeps_running()) at.engine_->run(woken);
                             return at.keeps_running();
                         },
                         [](void* self) noexcept {
                             auto& at = *static_cast<Activity*>(self);
                             if (at.keeps_running()) at.engine_->run(false);
                             return at.keeps_running();
                         },
                         engine_->now_address()}};
    part.type->loop(part.component_, control);
}

// The activity's own thread leaves the safe values after it broke a contract; the code that broke it runs no
// more. If the stop itself breaks a contract, it finds the stop claimed.
void Activity::park() noexcept TAPPET_REALTIME {
    is_lost_.store(true, std::memory_order_release);
    state_.store(State::parked, std::memory_order_release);
    while (keeps_running())
        TAPPET_ESCAPE("this thread must not go on: its contract is broken", os::sleep_for(1ms));
    if (claim_engine_stop()) {
        engine_->stop(clock_->now());
        engine_->mark_failed();
        state_.store(State::stopped, std::memory_order_release);
    }
    sleep_for_ever();
}

void Activity::sleep_for_ever() noexcept TAPPET_REALTIME {
    while (true) TAPPET_ESCAPE("this thread must not go on: its contract is broken", os::sleep_for(1h));
}

} // namespace tappet

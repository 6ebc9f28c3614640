// One execution of a task in each of the five settings, with its stamps.
#include "tests/figures/experiments/task.hpp"

#include "tests/figures/measure/candidates.hpp"

#include <unistd.h>

namespace tappet::experiments {

using figures::ticks;

void Task::assign(const Assignment& assignment) {
    assignment_ = assignment;
    turns_of_load_ = turns_for(load.get(), assignment.turns_per_ns);
    turns_of_service_ = turns_of_load_ / 10;
}

void Task::start(const Cycle&) noexcept TAPPET_REALTIME {
    TAPPET_ESCAPE("once, before the first execution", thread_.store(gettid(), std::memory_order_release));
}

std::uint32_t Task::since(std::uint64_t first) const noexcept TAPPET_REALTIME {
    const std::uint64_t passed = ticks() - first;
    return static_cast<std::uint32_t>(
        passed > assignment_.ticks_of_stamps ? passed - assignment_.ticks_of_stamps : 0);
}

// The engine served commands and messages after the last step.
void Task::account_for_serving() noexcept TAPPET_REALTIME {
    const FunctionTiming& timing = *assignment_.reactions;
    if (executed_ > 0) {
        Execution& before = assignment_.record[executed_ - 1];
        before.served = static_cast<std::uint32_t>(timing.passes - passes_);
        before.serving = static_cast<std::uint64_t>((timing.total - total_).count());
    }
    passes_ = timing.passes;
    total_ = timing.total;
}

void Task::step(const Cycle&) noexcept TAPPET_REALTIME {
    Execution now;
    now.begin = ticks();
    account_for_serving();
    const Setting how = setting.get();
    if (how == Setting::locked) {
        const std::uint64_t first = ticks();
        TAPPET_ESCAPE("locks are what is compared here", lock_and_read_all());
        now.exchange += since(first);
    } else if (how == Setting::data) {
        const std::uint64_t first = ticks();
        read_all();
        now.exchange += since(first);
    }
    if (how != Setting::commands && how != Setting::events) turn(turns_of_load_);
    own_[0] += 1;
    if (how == Setting::locked) {
        const std::uint64_t first = ticks();
        TAPPET_ESCAPE("locks are what is compared here", lock_and_write_all());
        now.exchange += since(first);
    } else if (how == Setting::data) {
        const std::uint64_t first = ticks();
        write_all();
        now.exchange += since(first);
    } else if (how == Setting::commands) {
        send(now);
    } else if (how == Setting::events) {
        emit(now);
    }
    now.busy = since(now.begin);
    if (how == Setting::none) {
        now.copies = copy_bare();
        // Alternating: the second of two in a row would find its data in the cache.
        if (executed_ % 2 == 0)
            now.one_message = post_bare(1);
        else
            now.two_messages = post_bare(2);
    }
    if (executed_ < assignment_.record.size()) assignment_.record[executed_++] = now;
}

// A port without a connection has no mutex either.
void Task::read_all() noexcept TAPPET_REALTIME {
    if (assignment_.ports.from_higher != nullptr) static_cast<void>(from_higher.read(seen_));
    if (assignment_.ports.from_lower != nullptr) static_cast<void>(from_lower.read(seen_));
    for (std::size_t i = 0; i < assignment_.drain_at_most; ++i)
        if (!drain.pop(seen_)) break;
    figures::keep(seen_);
}

void Task::write_all() noexcept TAPPET_REALTIME {
    if (assignment_.ports.to_higher != nullptr) to_higher.write(own_);
    if (assignment_.ports.to_lower != nullptr) to_lower.write(own_);
    for (std::size_t i = 0; i < assignment_.fill_at_most; ++i)
        if (!fill.push(own_)) break;
}

void Task::lock_and_read_all() noexcept {
    const LockedPorts& ports = assignment_.ports;
    if (ports.from_higher != nullptr) waited_for_locks_ += ports.from_higher->read(seen_);
    if (ports.from_lower != nullptr) waited_for_locks_ += ports.from_lower->read(seen_);
    for (std::size_t i = 0; i < assignment_.drain_at_most; ++i) {
        const auto answer = ports.drain->pop(seen_);
        waited_for_locks_ += answer.waited;
        if (!answer.done) break;
    }
    figures::keep(seen_);
}

void Task::lock_and_write_all() noexcept {
    const LockedPorts& ports = assignment_.ports;
    if (ports.to_higher != nullptr) waited_for_locks_ += ports.to_higher->write(own_);
    if (ports.to_lower != nullptr) waited_for_locks_ += ports.to_lower->write(own_);
    for (std::size_t i = 0; i < assignment_.fill_at_most; ++i) {
        const auto answer = ports.fill->push(own_);
        waited_for_locks_ += answer.waited;
        if (!answer.done) break;
    }
}

// "An activity only sends a command if it received one from its neighbour" (4.5.4); the first ones are free.
void Task::send(Execution& now) noexcept TAPPET_REALTIME {
    const bool to_above = ask_higher.connected() && higher_answered_ && !in_flight(ask_higher.state());
    const bool to_below = ask_lower.connected() && lower_answered_ && !in_flight(ask_lower.state());
    if (to_above) {
        const std::uint64_t first = ticks();
        static_cast<void>(ask_higher.send());
        now.sent = since(first);
        higher_answered_ = false;
    }
    if (to_below) {
        const std::uint64_t first = ticks();
        static_cast<void>(ask_lower.send());
        // The time of one command, whether one or two were sent.
        now.sent = to_above ? (now.sent + since(first)) / 2 : since(first);
        lower_answered_ = false;
    }
}

void Task::emit(Execution& now) noexcept TAPPET_REALTIME {
    if (!higher_answered_ && !lower_answered_) return;
    higher_answered_ = lower_answered_ = false;
    const std::uint64_t first = ticks();
    pulse.emit(now.begin);
    now.sent = since(first);
}

bool Task::serve_higher() noexcept TAPPET_REALTIME {
    serve();
    return higher_answered_ = true;
}
bool Task::serve_lower() noexcept TAPPET_REALTIME {
    serve();
    return lower_answered_ = true;
}
void Task::hear_higher(std::uint64_t) noexcept TAPPET_REALTIME { static_cast<void>(serve_higher()); }
void Task::hear_lower(std::uint64_t) noexcept TAPPET_REALTIME { static_cast<void>(serve_lower()); }

// The floor of data flow: the cost of the same packets without any other thread.
std::uint32_t Task::copy_bare() noexcept TAPPET_REALTIME {
    const LockedPorts& ports = assignment_.ports;
    const std::uint64_t first = ticks();
    if (ports.from_higher != nullptr) seen_ = bare_[0], figures::keep(seen_);
    if (ports.from_lower != nullptr) seen_ = bare_[1], figures::keep(seen_);
    if (ports.to_higher != nullptr) bare_[2] = own_, figures::keep(bare_[2]);
    if (ports.to_lower != nullptr) bare_[3] = own_, figures::keep(bare_[3]);
    return since(first);
}

// The floor of commands and events: the work that any notification needs.
std::uint32_t Task::post_bare(std::size_t messages) noexcept TAPPET_REALTIME {
    const std::uint64_t first = ticks();
    for (std::size_t i = 0; i < messages; ++i) {
        messages_[i].object = this;
        messages_[i].id = static_cast<std::uint32_t>(i);
        figures::keep(messages_[i]);
        announced_[i].fetch_or(1, std::memory_order_release);
    }
    return since(first);
}

} // namespace tappet::experiments

// Waiting for an event (thesis 4.6.1): an activity that is not real-time blocks until the event or a
// time-out; any other activity polls.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/facet_member.hpp"
#include "kernel/component/subscription.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/waiter.hpp"

#include <atomic>
#include <cstddef>
#include <span>

namespace tappet {

/// The state of an EventWait, for any arguments. One row brings it one event; the emissions wait in mailboxes
/// of its own, as many as the row's queue says.
class EventWaitState : FacetMember<member::wait> {
public:
    /// Sets up the wait; called by start-up. `activity`: the activity that an emission wakes, also while
    /// nobody waits.
    void place(Waker activity, const os::Clock& clock, std::span<Mailbox> mailboxes,
               std::size_t capacity) noexcept {
        activity_ = activity;
        clock_ = &clock;
        capacity_ = capacity;
        inbox_.place(mailboxes);
    }
    [[nodiscard]] Inbox& inbox() noexcept TAPPET_REALTIME { return inbox_; }
    /// Wakes after an emission was put into the inbox. Real-time, any thread.
    static void wake(void* self) noexcept TAPPET_REALTIME {
        auto& state = *static_cast<EventWaitState*>(self);
        state.waiter_.wake();
        state.activity_();
    }
    /// Ends the wait in progress, or the next one: for break_loop(). Real-time, any thread.
    void interrupt() noexcept TAPPET_REALTIME {
        interrupted_.store(true, std::memory_order_release);
        waiter_.wake();
    }
    /// The Message::Run of its row.
    static void receive(void* self, const std::byte* arguments) noexcept TAPPET_REALTIME {
        static_cast<EventWaitState*>(self)->arrived_ = arguments;
    }

protected:
    EventWaitState() = default;

    /// Returns the packed arguments of the next emission, or null. They stay in place until the next call.
    [[nodiscard]] const std::byte* next() noexcept TAPPET_REALTIME {
        arrived_ = nullptr;
        const std::size_t most = capacity_;
        for (std::size_t i = 0; i < most; ++i) { // what is outdated is passed over
            if (!inbox_.take(message_)) return nullptr;
            message_.run(message_.object, message_.arguments.data());
            if (arrived_ != nullptr) return arrived_;
        }
        return nullptr;
    }
    /// Sleeps until next() finds something, the time is over, or interrupt().
    [[nodiscard]] const std::byte* wait_for_next(Duration at_most) noexcept {
        const std::byte* came = next();
        if (clock_ == nullptr || clock_->is_virtual()) return came;
        const Time end = clock_->now() + at_most;
        // A wake for an emission that was already taken may be left over: it costs one more poll.
        while (came == nullptr && !interrupted_.exchange(false, std::memory_order_acq_rel) &&
               clock_->now() < end) {
            static_cast<void>(waiter_.wait(end));
            came = next();
        }
        return came;
    }

private:
    Inbox inbox_{};
    Message message_{};
    const std::byte* arrived_ = nullptr;
    os::Waiter waiter_{};
    Waker activity_{};
    const os::Clock* clock_ = nullptr;
    std::size_t capacity_ = 0;
    std::atomic<bool> interrupted_{false};
};

/// An EventWait with any arguments, for a component whose waits follow from a table.
class PackedEventWait : public EventWaitState {
public:
    PackedEventWait() = default;
    /// Takes the oldest waiting emission. Returns its packed arguments, valid until the next call; null:
    /// there is none.
    [[nodiscard]] const std::byte* take() noexcept TAPPET_REALTIME { return next(); }
};

/// A member of a component, with a row of its own: when("shaft.beat_up", tell("console.beat")). Used only in
/// its component's activity.
template <class... A>
class EventWait : public EventWaitState {
public:
    EventWait() = default;

    /// Takes the oldest waiting emission. Returns false when there is none. Real-time.
    [[nodiscard]] bool take(A&... into) noexcept TAPPET_REALTIME { return unpack(next(), into...); }

    /// As take(), but waits up to `at_most` for an emission. Returns false at the time-out or after
    /// interrupt(). Not real-time. Meanwhile its activity serves nothing else: choose a time below the
    /// patience of a stop, so that the activity can stop in time; in a loop(), break_loop() calls
    /// interrupt(). Under virtual time it never blocks, because time stands still while a component runs.
    [[nodiscard]] bool wait(Duration at_most, A&... into) noexcept {
        return unpack(wait_for_next(at_most), into...);
    }

private:
    static bool unpack([[maybe_unused]] const std::byte* packed, A&... into) noexcept TAPPET_REALTIME {
        if (packed == nullptr) return false;
        ((into = detail::unpack_one<A>(packed)), ...);
        return true;
    }
};

} // namespace tappet

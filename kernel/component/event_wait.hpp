// Waiting for an event (thesis 4.6.1): an activity that is not real-time blocks until it comes or a time is
// over; any other looks whether it came.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/component/subscription.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/waiter.hpp"

#include <atomic>
#include <cstddef>
#include <span>

namespace tappet {

/// What an EventWait keeps, whatever its arguments. One row tells it of one event; the emissions wait in
/// mailboxes of its own, as many as the row's queue says.
class EventWaitState {
public:
    /// Start-up's.
    void place(os::Waiter& waiter, const os::Clock& clock, std::span<Mailbox> mailboxes,
               std::size_t capacity) noexcept {
        waiter_ = &waiter;
        clock_ = &clock;
        capacity_ = capacity;
        inbox_.place(mailboxes);
    }
    [[nodiscard]] Inbox& inbox() noexcept TAPPET_REALTIME { return inbox_; }
    /// Wakes the activity that waits. Real-time, any thread.
    static void wake(void* self) noexcept TAPPET_REALTIME {
        auto& state = *static_cast<EventWaitState*>(self);
        state.told_.store(true, std::memory_order_release);
        if (state.waiter_ != nullptr) state.waiter_->wake();
    }
    /// Message::Run of its row.
    static void receive(void* self, const std::byte* arguments) noexcept TAPPET_REALTIME {
        static_cast<EventWaitState*>(self)->arrived_ = arguments;
    }

protected:
    ~EventWaitState() = default;

    /// The packed arguments of the next emission, or null; they stay where they are until the next call.
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
    /// Sleeps until next() finds something, the time is over, or something else wants the activity.
    [[nodiscard]] const std::byte* wait_for_next(Duration at_most) noexcept {
        if (const std::byte* came = next()) return came;
        if (clock_ == nullptr || clock_->is_virtual()) return nullptr;
        const Time end = clock_->now() + at_most;
        const std::byte* came = nullptr;
        bool woken = false;
        bool wanted = false;
        while (came == nullptr && !wanted && clock_->now() < end) {
            if (waiter_->wait_without_devices(end)) {
                woken = true;
                wanted = !told_.exchange(false, std::memory_order_acq_rel); // not by an emission
            }
            came = next();
        }
        // The wake may have meant the activity too: it looks again when this component has returned.
        if (woken) waiter_->wake();
        return came;
    }

private:
    Inbox inbox_{};
    Message message_{};
    const std::byte* arrived_ = nullptr;
    os::Waiter* waiter_ = nullptr;
    const os::Clock* clock_ = nullptr;
    std::size_t capacity_ = 0;
    std::atomic<bool> told_{false};
};

/// A member of a component, told by a row of its own: when("shaft.beat_up", tell("console.beat")). Used in
/// its component's activity only.
template <class... A>
class EventWait : public EventWaitState {
public:
    /// Takes the oldest emission that waits. False: there is none. Real-time.
    [[nodiscard]] bool take(A&... into) noexcept TAPPET_REALTIME { return unpack(next(), into...); }

    /// As take(), but waits up to `at_most` for one. False: the time is over, or the activity is wanted for
    /// something else (a message, a connection's wake, its stop): then return from work(). Not real-time.
    /// Under virtual time it never blocks: while work() runs, time stands still.
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

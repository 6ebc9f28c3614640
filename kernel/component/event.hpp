// Events (thesis 4.6): an emission runs every connected reaction: synchronous ones here and now, asynchronous
// ones in the receiver's engine. The subscribers are the table's reaction rows; emission is a loop over
// function pointers.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/component/life.hpp"
#include "kernel/component/port.hpp"
#include "kernel/exchange/mailbox.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace tappet {

/// One reaction row as the emitter sees it. The same size for every signature, so that the planner can place
/// it.
template <class... A>
struct Subscriber {
    void (*react)(void* context, A... arguments) noexcept TAPPET_REALTIME;
    void* context;
};

/// An event. Emitted by its own component only, from its own activity. Real-time.
template <class... A>
class Event {
    static_assert((std::is_trivially_copyable_v<A> && ...),
                  "arguments of an event are copied between activities");

public:
    void emit(A... arguments) noexcept TAPPET_REALTIME {
        const std::size_t count = count_; // a bound that no handler can move: a counted loop
        for (std::size_t i = 0; i < count; ++i) subscribers_[i].react(subscribers_[i].context, arguments...);
    }
    void operator()(A... arguments) noexcept TAPPET_REALTIME { emit(arguments...); }

private:
    friend struct PortAccess;
    Subscriber<A...>* subscribers_ = nullptr;
    std::size_t count_ = 0;
};

/// An asynchronous reaction row: it posts the emission's arguments to the receiver's engine. A row holds at
/// most `quota` unserved emissions; one more is counted as lost and named in the report.
struct AsyncReaction {
    Inbox* inbox = nullptr;
    std::size_t sender = 0;
    Waker waker{};
    Message::Run run = nullptr; ///< in the receiver: the operation, or the trigger of a behaviour
    void* object = nullptr;
    const AtomicComponentState* receiver = nullptr; ///< of the component that the operation belongs to
    std::uint32_t part = 0; ///< the receiver's number for the component it is timed as
    std::uint32_t quota = 0;
    std::uint32_t posted = 0; ///< the sender's own count
    std::uint32_t lost = 0;
    std::uint32_t high_water = 0;
    alignas(64) std::atomic<std::uint32_t> served{0}; ///< the receiver's count
    std::uint32_t dropped = 0; ///< the receiver's own count: they reached a component that does not run

    void post(Message& message) noexcept TAPPET_REALTIME {
        message.run = &serve;
        message.object = this;
        message.id = part;
        const std::uint32_t waiting = posted - served.load(std::memory_order_acquire);
        if (waiting >= quota || !inbox->post(sender, message)) {
            ++lost;
            return;
        }
        ++posted;
        if (waiting + 1 > high_water) high_water = waiting + 1;
        waker();
    }

private:
    static void serve(void* self, const std::byte* arguments) noexcept TAPPET_REALTIME {
        auto& row = *static_cast<AsyncReaction*>(self);
        // Its place in the mailbox is free again, so one more may be posted while this one runs.
        row.served.store(row.served.load(std::memory_order_relaxed) + 1, std::memory_order_release);
        if (row.receiver != nullptr && !is_running(*row.receiver))
            ++row.dropped;
        else
            row.run(row.object, arguments);
    }
};

namespace detail {

template <class... A>
inline constexpr std::size_t packed_bytes = (std::size_t{0} + ... + sizeof(A));

/// Puts the arguments one behind the other into a message.
template <class... A>
void pack(std::byte* into, const A&... arguments) noexcept TAPPET_REALTIME {
    std::size_t at = 0;
    ((std::memcpy(into + at, &arguments, sizeof(A)), at += sizeof(A)), ...);
}

template <class T>
T unpack_one(const std::byte*& from) noexcept TAPPET_REALTIME {
    T value;
    std::memcpy(&value, from, sizeof(T));
    from += sizeof(T);
    return value;
}

template <class... A>
inline constexpr bool fits_one_message = packed_bytes<A...> <= sizeof(Message::arguments);

/// The check of the table refuses an asynchronous reaction to an event whose arguments do not fit; that
/// event's synchronous reactions are good.
template <class... A>
void post(void* reaction, A... arguments) noexcept TAPPET_REALTIME {
    if constexpr (fits_one_message<A...>) {
        auto& row = *static_cast<AsyncReaction*>(reaction);
        Message message;
        pack(message.arguments.data(), arguments...);
        row.post(message);
    }
}

} // namespace detail

} // namespace tappet

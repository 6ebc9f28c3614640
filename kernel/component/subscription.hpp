// An asynchronous subscription (thesis 4.6.2): it catches the arguments of an emission for another engine.
// One bit connects it. Its epoch identifies emissions caught before it was last disconnected.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/component/cause.hpp"
#include "kernel/component/current.hpp"
#include "kernel/component/life.hpp"
#include "kernel/component/port.hpp"
#include "kernel/exchange/latest_message.hpp"
#include "kernel/exchange/mailbox.hpp"

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tappet {

/// A counter: one thread counts, any thread may read.
class Counter {
public:
    void add() noexcept TAPPET_REALTIME { set(value() + 1); }
    void set(std::uint32_t value) noexcept TAPPET_REALTIME {
        value_.store(value, std::memory_order_relaxed); // no step: counted for the report
    }
    [[nodiscard]] std::uint32_t value() const noexcept TAPPET_REALTIME {
        return value_.load(std::memory_order_relaxed); // no step: counted for the report
    }

private:
    std::atomic<std::uint32_t> value_{0};
};

struct AsyncReaction;

/// Arguments for which a message has no room. For an event that has such arguments, each lane keeps them
/// beside the mailbox. It has so many places of this size that an emission being handled stays in place while
/// the quota waits.
struct Parcel {
    const void* arguments = nullptr;
    void (*pack)(std::byte* into, const void* arguments) noexcept TAPPET_REALTIME = nullptr;
};
/// Returns the bytes of a place, a multiple of a word; 0: a message has room.
constexpr std::size_t parcel_bytes(std::size_t argument_bytes) noexcept {
    constexpr std::size_t word = sizeof(std::uint64_t);
    return argument_bytes <= sizeof(Message::arguments) ? 0 : (argument_bytes + word - 1) / word * word;
}
/// Returns the number of places: a power of two, so that 32-bit counters find their place after a wrap too.
constexpr std::uint32_t parcel_places(std::uint32_t quota, bool keeps_latest) noexcept {
    return std::bit_ceil(keeps_latest ? LatestMessage::places : quota + 1);
}
static_assert(parcel_places(1, false) == 2 && parcel_places(3, false) == 4 && parcel_places(4, false) == 8);

/// The share of one emitting activity in an asynchronous subscription. Emitters of one event share no lane.
struct EventLane {
    AsyncReaction* row = nullptr;
    std::size_t sender = 0;          ///< the activity's number at the receiving inbox
    LatestMessage* latest = nullptr; ///< for a row that keeps the latest only
    std::byte* parcels = nullptr;    ///< null: the arguments are in the message
    // Counted by the emitter.
    Counter posted{};
    Counter lost{}; ///< no room, or replaced by a later one
    Counter high_water{};
    // Counted by the receiver.
    alignas(64) std::atomic<std::uint32_t> served{0};
    Counter outdated{}; ///< dropped, because they were caught before the row was disconnected
    Counter dropped{};  ///< they reached a component that does not run
};

/// The sum of the counts of a subscription's lanes.
struct SubscriptionCounts {
    std::uint64_t posted = 0;
    std::uint64_t served = 0; ///< includes those below
    std::uint64_t lost = 0;
    std::uint64_t outdated = 0;
    std::uint64_t dropped = 0;
    std::uint64_t stray = 0; ///< in lost too: emitted by an activity from which no row leads to the event
    std::uint32_t high_water = 0; ///< of the fullest lane
};

/// An asynchronous reaction row. Each of its lanes holds at most `quota` unserved emissions, or only the
/// latest one. Any more are counted as lost and named in the report.
struct AsyncReaction {
    static constexpr std::uint8_t no_lane = 0xff;

    Inbox* inbox = nullptr;
    Waker waker{};
    GatedComponent* receiver = nullptr; ///< the component that reacts
    /// Its operation. Null: `run` with `object` reacts in its place, which is the trigger of a behaviour.
    bool (*operation)(GatedComponent&, Entry, const std::byte*) noexcept TAPPET_REALTIME = nullptr;
    Message::Run run = nullptr;
    void* object = nullptr;
    std::atomic<std::uint64_t>* connected = nullptr; ///< of the event: one bit for each of its rows
    std::uint64_t bit = 0;
    EventLane* lanes = nullptr;
    const std::uint8_t* lane_of = nullptr; ///< the lane of each activity
    std::uint8_t outside = no_lane;        ///< lane of a thread without activity: only virtual time's has one
    std::uint32_t activities = 0;
    std::uint32_t lane_count = 0;
    std::uint32_t part = 0; ///< the receiver's number for the component it is timed as
    std::uint32_t quota = 0;
    std::uint32_t parcel_bytes = 0;
    std::uint32_t parcel_mask = 0;       ///< number of places minus one
    std::atomic<std::uint32_t> stray{0}; ///< any thread counts
    bool has_run = false;  ///< the receiver's: the last served message was neither outdated nor dropped
    ReactionTimes times{}; ///< the receiver's
    alignas(64) std::atomic<std::uint32_t> epoch{0};

    /// Posts an emission, in the emitter. The epoch is read before the bit: a message posted with an epoch
    /// found the row connected in that epoch, and disconnect() clears the bit before it advances the epoch.
    /// Real-time.
    void post(Message& message, const Parcel* parcel = nullptr) noexcept TAPPET_REALTIME {
        message.epoch = epoch.load(std::memory_order_acquire);               // emit.epoch
        if ((connected->load(std::memory_order_acquire) & bit) == 0) return; // emit.bit
        const std::uint32_t activity = running_activity();
        const std::uint8_t index = activity < activities ? lane_of[activity] : outside;
        if (index == no_lane) {
            stray.fetch_add(1, std::memory_order_relaxed); // no step: counted for the report
            return;
        }
        message.run = &serve;
        message.object = &lanes[index];
        message.id = part;
        message.cause = running_cause();
        post_to(lanes[index], message, parcel);
    }
    /// Returns the arguments of a message as whole words, in the receiver, before the message is served. For
    /// a row that keeps the latest they cannot be seen yet.
    [[nodiscard]] static std::span<const std::byte> arguments_of(const Message& message) noexcept
        TAPPET_REALTIME {
        if (message.run != &serve) return message.arguments;
        const auto& lane = *static_cast<const EventLane*>(message.object);
        if (lane.parcels == nullptr || lane.latest != nullptr) return message.arguments;
        const std::uint32_t next = lane.served.load(std::memory_order_relaxed); // no step: its own counter
        return {lane.row->place_of(lane, next), lane.row->parcel_bytes};
    }
    /// Notes, in the receiver, that the reaction to this message ended at `end`.
    static void note_end(const Message& message, Time end) noexcept TAPPET_REALTIME {
        if (message.run != &serve) return;
        AsyncReaction& row = *static_cast<EventLane*>(message.object)->row;
        if (row.has_run) row.times.add(end - message.cause);
    }
    [[nodiscard]] SubscriptionCounts counts() const noexcept TAPPET_REALTIME {
        SubscriptionCounts sum;
        sum.stray = stray.load(std::memory_order_relaxed); // no step: for the report
        sum.lost = sum.stray;
        for (std::uint32_t i = 0; i < lane_count; ++i) {
            const EventLane& lane = lanes[i];
            sum.posted += lane.posted.value();
            sum.served += lane.served.load(std::memory_order_acquire); // no step: for the report
            sum.lost += lane.lost.value();
            sum.outdated += lane.outdated.value();
            sum.dropped += lane.dropped.value();
            if (lane.high_water.value() > sum.high_water) sum.high_water = lane.high_water.value();
        }
        return sum;
    }

private:
    [[nodiscard]] std::byte* place_of(const EventLane& lane, std::uint32_t number) const noexcept
        TAPPET_REALTIME {
        return lane.parcels + std::size_t{number & parcel_mask} * parcel_bytes;
    }
    void post_to(EventLane& lane, const Message& message, const Parcel* parcel) noexcept TAPPET_REALTIME {
        if (lane.latest != nullptr) {
            post_latest(lane, message, parcel);
            return;
        }
        const std::uint32_t posted = lane.posted.value();
        const std::uint32_t waiting = posted - lane.served.load(std::memory_order_acquire); // emit.quota
        const bool has_room = waiting < quota;
        if (has_room && parcel != nullptr) parcel->pack(place_of(lane, posted), parcel->arguments);
        if (!has_room || !inbox->post(lane.sender, message)) {
            lane.lost.add();
            return;
        }
        lane.posted.set(posted + 1);
        if (waiting + 1 > lane.high_water.value()) lane.high_water.set(waiting + 1);
        waker();
    }
    void post_latest(EventLane& lane, const Message& message, const Parcel* parcel) noexcept TAPPET_REALTIME {
        if (parcel != nullptr) parcel->pack(place_of(lane, lane.latest->place_of_next()), parcel->arguments);
        if (!lane.latest->put(message)) { // the replaced one was announced: no second wake is needed
            lane.lost.add();
            return;
        }
        Message notice;
        notice.run = message.run;
        notice.object = message.object;
        notice.id = message.id;
        notice.cause = message.cause;
        lane.posted.add();
        lane.high_water.set(1);
        if (inbox->post(lane.sender, notice)) waker(); // there is room: at most one notice is waiting
    }

    static void serve(void* self, const std::byte* arguments) noexcept TAPPET_REALTIME {
        auto& lane = *static_cast<EventLane*>(self);
        AsyncReaction& row = *lane.row;
        // Its place in the mailbox is free again, so one more may be posted while this one runs.
        const std::uint32_t served = lane.served.load(std::memory_order_relaxed); // serve.count
        lane.served.store(served + 1, std::memory_order_release);                 // serve.count
        row.has_run = false;
        const Message* caught = lane.latest != nullptr ? lane.latest->take() : &message_of(arguments);
        if (caught == nullptr) return;
        if (caught->epoch != row.epoch.load(std::memory_order_acquire)) // serve.epoch
            lane.outdated.add();
        else {
            const std::uint32_t place = lane.latest != nullptr ? lane.latest->place_of_taken() : served;
            row.has_run =
                row.react(lane.parcels == nullptr ? caught->arguments.data() : row.place_of(lane, place));
            if (!row.has_run) lane.dropped.add();
        }
    }
    [[nodiscard]] bool react(const std::byte* packed) noexcept TAPPET_REALTIME {
        if (operation != nullptr) return operation(*receiver, Entry::queued, packed);
        return receiver->enter(Entry::queued, [&](void*) noexcept TAPPET_REALTIME { run(object, packed); });
    }
};

namespace detail {

template <class... A>
inline constexpr std::size_t packed_bytes = (std::size_t{0} + ... + sizeof(A));

/// Packs the arguments one after the other into a message.
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

/// Posts an emission. Arguments without room in a message are packed in their place, once room is certain.
template <class... A>
void post(void* reaction, A... arguments) noexcept TAPPET_REALTIME {
    auto& row = *static_cast<AsyncReaction*>(reaction);
    Message message;
    if constexpr (parcel_bytes(packed_bytes<A...>) == 0) {
        pack(message.arguments.data(), arguments...);
        row.post(message);
    } else {
        const auto write = [&](std::byte* into) noexcept TAPPET_REALTIME { pack(into, arguments...); };
        const Parcel parcel{&write, [](std::byte* into, const void* self) noexcept
                            TAPPET_REALTIME { (*static_cast<decltype(&write)>(self))(into); }};
        row.post(message, &parcel);
    }
}

} // namespace detail

} // namespace tappet

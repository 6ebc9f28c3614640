// A CAN controller as the drivers' components see it; implemented by SocketCAN and by the in-process twin.
#pragma once

#include "drivers/can/frame.hpp"
#include "drivers/can/kind.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/component/one_activity.hpp"
#include "kernel/component/wire_counters.hpp"
#include "kernel/os/waiter.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace tappet::can {

enum class Received : std::uint8_t { none, frame, error_frame };

struct Receive {
    Received what = Received::none;
    std::uint32_t lost = 0; ///< frames lost just before this one: buffers were full
};

enum class Send : std::uint8_t {
    queued,          ///< sent in the order of identifiers, unless it becomes too old first
    replaced,        ///< it took the place of an older frame of the same identifier
    refused_full,    ///< the queue is full
    refused_fault,   ///< the bus is faulted: nothing is sent before restart()
    refused_stale,   ///< made before the last restart, or older than max_age
    refused_invalid, ///< identifier or length out of range, or CAN FD on a bus without it
};

/// How to treat an older frame of the same identifier that is still queued.
enum class Keep : std::uint8_t {
    latest, ///< cyclic contents: the newer frame replaces the older
    every,  ///< commands: every frame is sent, in order
    last,   ///< final frames: sent after everything else, in order, and never too old
};

enum class Restart : std::uint8_t {
    done,       ///< the controller was restarted; the next service() starts to use it
    not_needed, ///< the bus is not faulted, or a restart is already under way
    exhausted,  ///< all allowed restarts are used up: the bus needs service
    failed,     ///< the interface could not be brought back
};

struct Counters {
    std::uint64_t received = 0;
    std::uint64_t sent = 0;           ///< confirmed by the controller: somebody acknowledged
    std::uint64_t lost_in_kernel = 0; ///< arrived, and dropped because a buffer was full
    std::uint64_t error_frames = 0;
    std::uint64_t malformed = 0;     ///< not a frame, or an invalid length; never handed on
    std::uint64_t impostors = 0;     ///< other nodes sent an identifier that this end sends
    std::uint64_t refused = 0;       ///< sends not accepted
    std::uint64_t replaced = 0;      ///< frames that replaced their predecessor in the queue
    std::uint64_t dropped_stale = 0; ///< accepted and never sent: too old, or purged at a fault
    std::uint64_t sent_late = 0;     ///< confirmed only after max_age: they were already in the controller
    std::uint64_t back_pressure = 0; ///< the kernel had no room; the frame stayed in our queue
    std::uint64_t faults = 0;        ///< bus-off, unacknowledged, down
    std::uint64_t restarts = 0;
    bool operator==(const Counters&) const = default;

    void tell(WireCounters& into) const noexcept {
        into.add("can_frames_lost", lost_in_kernel);
        into.add("can_faults", faults);
        into.add("can_restarts", restarts);
        into.add("can_impostors", impostors);
        into.add("can_malformed", malformed);
    }
};

struct Settings {
    std::string_view interface{};           ///< named by the board
    std::span<const Identifier> receive{};  ///< only these are received
    std::span<const Identifier> transmit{}; ///< only these may be sent
    std::uint32_t in_flight = 4;            ///< most unconfirmed frames; see frames_in_flight()
    Duration max_age = 20ms;                ///< an older frame is not sent any more
    Duration confirm_within = 50ms;         ///< a frame unconfirmed for longer is a fault
    std::uint32_t restarts_allowed = 3;
    std::uint32_t bit_rate = 0;         ///< the controller's required rate, as the board states
    std::uint32_t data_bit_rate = 0;    ///< the same for CAN FD's data phase; 0: classical CAN only
    bool takes_fd = false;              ///< receives and sends CAN FD frames: the map has at least one
    int receive_buffer_bytes = 1 << 20; ///< Linux's default holds 278 frames
};

/// A frame that was acknowledged: when its contents were made and when it was confirmed. Time{}: none.
struct Confirmation {
    Time made{}, at{};
    bool operator==(const Confirmation&) const = default;
};

/// All calls belong to one activity and are real-time, except restart(), which blocks and belongs to a
/// background activity. A faulted bus is silent: its device wakes no activity until it is restarted.
class Device {
public:
    virtual ~Device() = default;

    /// Takes the next frame that arrived. Writes `frame` unless it returns `none`.
    virtual Receive receive(Frame& frame) noexcept TAPPET_REALTIME = 0;
    /// Discards everything that has arrived.
    virtual void drop_arrivals() noexcept TAPPET_REALTIME {
        constexpr int most = 4096; // the kernel's buffer holds fewer
        Frame ignored;
        for (int n = 0; n < most; ++n) {
            const Receive got = receive(ignored);
            if (got.what == Received::none && got.lost == 0) return;
        }
    }
    /// Queues a frame whose contents were made at frame.stamp.
    virtual Send send(const Frame& frame, Keep keep) noexcept TAPPET_REALTIME = 0;
    Send send(const Frame& frame) noexcept TAPPET_REALTIME { return send(frame, Keep::latest); }
    /// Called once per activation, after the sends: hands frames to the controller, drops old ones, detects
    /// time-outs and restarts.
    virtual void service(Time now) noexcept TAPPET_REALTIME = 0;
    /// The owner's last call before it stops: sends what is queued at once, because nobody calls service()
    /// any more. Takes a few milliseconds at most for each frame. Drops frames that arrive meanwhile, so it
    /// must not be called while others share the device. Returns false when not everything was sent or a
    /// frame was not acknowledged.
    virtual bool finish(Time now) noexcept TAPPET_REALTIME = 0;
    /// Returns when service() is due even if nothing arrives: the next time-out of a frame, or never.
    [[nodiscard]] virtual Time next_service() const noexcept TAPPET_REALTIME = 0;

    [[nodiscard]] virtual State state() const noexcept TAPPET_REALTIME = 0;
    [[nodiscard]] virtual Counters counters() const noexcept TAPPET_REALTIME = 0;
    /// Returns the longest time from frame.stamp to the confirmation, over all frames sent with this
    /// identifier. 0: none was confirmed, or the device does not measure it.
    [[nodiscard]] virtual Duration longest_response(Identifier) const noexcept TAPPET_REALTIME { return {}; }
    /// Returns the last confirmed frame with this identifier; none when the device does not record it.
    [[nodiscard]] virtual Confirmation last_confirmed(Identifier) const noexcept TAPPET_REALTIME {
        return {};
    }
    /// Drops everything queued for sending; an emergency stop calls this.
    virtual void purge() noexcept TAPPET_REALTIME = 0;
    /// Not real-time. Brings a faulted controller back and drops everything it still held.
    virtual Restart restart() noexcept = 0;

    /// Lets each arrival wake `waiter` from now on; it must outlive the device. A confirmation that is waited
    /// for wakes it too; other confirmations are reported with the next event. Not real-time. Returns false
    /// when the waiter already watches too many devices.
    [[nodiscard]] virtual bool wakes(os::Waiter& waiter) noexcept = 0;
    /// Lets each confirmation wake the waiter, too. Not real-time.
    virtual void wake_when_confirmed() noexcept {}

protected:
    OneActivity belongs_to_; ///< checked by every call that belongs to the activity; copies do not have it
};

} // namespace tappet::can

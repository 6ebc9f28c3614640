// A CAN controller as drivers' components see it; the kernel's sockets and the in-process twin stand behind
// it.
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
    queued,          ///< it goes out in the order of identifiers unless it grows too old first
    replaced,        ///< it took the place of an older frame of the same identifier
    refused_full,    ///< the queue is full
    refused_fault,   ///< the bus is faulted: nothing is sent before restart()
    refused_stale,   ///< made before the last restart, or older than max_age
    refused_invalid, ///< identifier or length out of range, or CAN FD on a bus without it
};

/// What happens to an older frame of the same identifier that still waits.
enum class Keep : std::uint8_t {
    latest, ///< cyclic contents: the newer replaces the older
    every,  ///< commands: all go out, in their order
    last,   ///< last words: behind everything else, in their order, and never too old
};

enum class Restart : std::uint8_t {
    done,       ///< the controller was restarted; the next service() takes it into use
    not_needed, ///< the bus is not faulted, or a restart is already under way
    exhausted,  ///< all allowed restarts are used up: somebody must look at the bus
    failed,     ///< the interface could not be brought back
};

struct Counters {
    std::uint64_t received = 0;
    std::uint64_t sent = 0;           ///< confirmed by the controller: somebody acknowledged
    std::uint64_t lost_in_kernel = 0; ///< arrived and dropped for want of room
    std::uint64_t error_frames = 0;
    std::uint64_t malformed = 0;     ///< no frame, or of a length that there is not; never handed on
    std::uint64_t impostors = 0;     ///< others sent an identifier that is ours to send
    std::uint64_t refused = 0;       ///< sends not accepted
    std::uint64_t replaced = 0;      ///< sends that overtook their predecessor
    std::uint64_t dropped_stale = 0; ///< accepted, never sent: too old or purged at a fault
    std::uint64_t sent_late = 0;     ///< confirmed only after max_age: they were in the controller already
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
    std::span<const Identifier> receive{};  ///< exactly these are let through
    std::span<const Identifier> transmit{}; ///< exactly these may be sent
    std::uint32_t in_flight = 4;            ///< frames handed over and not confirmed; see frames_in_flight()
    Duration max_age = 20ms;                ///< a frame older than this is not sent any more
    Duration confirm_within = 50ms;         ///< an unconfirmed frame older than this is a fault
    std::uint32_t restarts_allowed = 3;
    std::uint32_t bit_rate = 0;      ///< what the controller must be set to, as the board says
    std::uint32_t data_bit_rate = 0; ///< likewise of CAN FD's data phase; 0: the board has classical CAN only
    bool takes_fd = false;           ///< CAN FD frames are received and sent: there is one in the map
    int receive_buffer_bytes = 1 << 20; ///< the default of Linux holds 278 frames
};

/// A frame that somebody acknowledged: when its contents were made, and when it was through. At Time{}: none.
struct Confirmation {
    Time made{}, at{};
    bool operator==(const Confirmation&) const = default;
};

/// All calls belong to one activity and are real-time, except restart(): it blocks, and belongs to a
/// background activity. A faulted bus is silent: its device wakes nobody until it is restarted.
class Device {
public:
    virtual ~Device() = default;

    /// The next frame that arrived. `frame` is written unless the answer is `none`.
    virtual Receive receive(Frame& frame) noexcept TAPPET_REALTIME = 0;
    /// All that has arrived is forgotten.
    virtual void drop_arrivals() noexcept TAPPET_REALTIME {
        constexpr int most = 4096; // the kernel's buffer holds fewer
        Frame ignored;
        for (int n = 0; n < most; ++n) {
            const Receive got = receive(ignored);
            if (got.what == Received::none && got.lost == 0) return;
        }
    }
    /// Accepts a frame whose contents were made at frame.stamp.
    virtual Send send(const Frame& frame, Keep keep) noexcept TAPPET_REALTIME = 0;
    Send send(const Frame& frame) noexcept TAPPET_REALTIME { return send(frame, Keep::latest); }
    /// Once per activation, after the sends: hands frames over, drops old ones, notices time-outs and
    /// restarts.
    virtual void service(Time now) noexcept TAPPET_REALTIME = 0;
    /// The owner's last call before it rests: what waits goes out now, since nobody serves the device after
    /// this. Takes some milliseconds at most for each frame. What arrives meanwhile is dropped: not for who
    /// shares the device. False: not all went out, or nobody acknowledged it.
    virtual bool finish(Time now) noexcept TAPPET_REALTIME = 0;
    /// When service() has something to do even if nothing arrives: the next time-out of a frame, or never.
    [[nodiscard]] virtual Time next_service() const noexcept TAPPET_REALTIME = 0;

    [[nodiscard]] virtual State state() const noexcept TAPPET_REALTIME = 0;
    [[nodiscard]] virtual Counters counters() const noexcept TAPPET_REALTIME = 0;
    /// Of what is sent with this identifier: the longest from frame.stamp until it was confirmed. Nought:
    /// none was, or the device does not look.
    [[nodiscard]] virtual Duration longest_response(Identifier) const noexcept TAPPET_REALTIME { return {}; }
    /// Of what is sent with this identifier: the last one. A device that does not look answers none.
    [[nodiscard]] virtual Confirmation last_confirmed(Identifier) const noexcept TAPPET_REALTIME {
        return {};
    }
    /// Drops everything that waits to be sent: an emergency stop calls this.
    virtual void purge() noexcept TAPPET_REALTIME = 0;
    /// Not real-time. Brings a faulted controller back, with everything it still held dropped.
    virtual Restart restart() noexcept = 0;

    /// From now on what arrives wakes `waiter`, which outlives the device. So does a confirmation that others
    /// wait for; what else is confirmed is told with what comes next. Not real-time. False: the waiter
    /// watches too many devices.
    [[nodiscard]] virtual bool wakes(os::Waiter& waiter) noexcept = 0;
    /// Each confirmation wakes, too. Not real-time.
    virtual void wake_when_confirmed() noexcept {}

protected:
    OneActivity belongs_to_; ///< checked by every call that belongs to the activity; no copy has it
};

} // namespace tappet::can

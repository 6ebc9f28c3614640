// The state of a controller, common to both worlds: state of the bus, faults, restarts, and the frames that
// may be sent.
#pragma once

#include "drivers/can/recovery.hpp"
#include "drivers/can/transmitter.hpp"

namespace tappet::can {

/// The owner's calls are real-time; `recovery` is also used by restart().
class Controller {
public:
    /// Resets everything. Not real-time. `state` is the present state of the bus, without a fault.
    void configure(const Settings& settings, State state = State::active) noexcept {
        transmitter_ = {};
        transmitter_.configure(settings);
        transmit_ = settings.transmit;
        takes_fd_ = settings.takes_fd;
        recovery.reset(settings.restarts_allowed);
        state_ = state;
        count = {};
        longest_ = {};
        last_ = {};
    }
    Send accept(const Frame& frame, Keep keep) noexcept TAPPET_REALTIME {
        if (faulted(state_)) return refuse(Send::refused_fault);
        if (!ours(frame) || (frame.fd && !takes_fd_)) return refuse(Send::refused_invalid);
        return transmitter_.push(frame, keep, count);
    }
    /// Takes a finished restart into use, detects missing acknowledgements, drops frames that are too old.
    /// Returns true when a restart was taken into use. `more_waits`: there may be unread confirmations; then
    /// the time-out is doubled.
    bool tick(Time now, bool more_waits = false) noexcept TAPPET_REALTIME {
        const bool restarted = recovery.taken_up();
        if (restarted) {
            transmitter_.restarted(now, count);
            state_ = State::active;
            ++count.restarts;
        }
        if (!faulted(state_) && transmitter_.unacknowledged(now, more_waits ? 2 : 1))
            fault(State::unacknowledged);
        return restarted;
    }
    /// Returns the frame to hand over now, or null.
    const Frame* next(Time now) noexcept TAPPET_REALTIME {
        return faulted(state_) ? nullptr : transmitter_.next(now, count);
    }
    /// Takes the next frame regardless of those in flight; its confirmation is not awaited. Returns false
    /// when there is none.
    bool take_waiting(Frame& frame) noexcept TAPPET_REALTIME {
        return !faulted(state_) && transmitter_.take_waiting(frame);
    }
    void handed_over(Time now) noexcept TAPPET_REALTIME { transmitter_.handed_over(now); }
    /// `is_exact`: the time is that of the confirmation, not of its reading.
    void confirmed(Time now, bool is_exact = true) noexcept TAPPET_REALTIME {
        const Transmitter::Flight sent = transmitter_.confirmed(now, count);
        const std::size_t which = index_of(sent.identifier);
        if (sent.made == Time{} || which >= longest_.size()) return;
        if (is_exact) longest_[which] = std::max(longest_[which], now - sent.made);
        last_[which] = {sent.made, now};
    }
    [[nodiscard]] Duration longest_response(Identifier of) const noexcept TAPPET_REALTIME {
        const std::size_t which = index_of(of);
        return which < longest_.size() ? longest_[which] : Duration::zero();
    }

    [[nodiscard]] Confirmation last_confirmed(Identifier of) const noexcept TAPPET_REALTIME {
        const std::size_t which = index_of(of);
        return which < last_.size() ? last_[which] : Confirmation{};
    }

    void report(const BusError& error) noexcept TAPPET_REALTIME {
        ++count.error_frames;
        if (faulted(error.state))
            fault(error.state);
        else if (!faulted(state_))
            state_ = error.state; // only a restart ends a fault
    }
    void fault(State kind) noexcept TAPPET_REALTIME {
        if (faulted(state_)) {
            if (kind > state_) state_ = kind; // unacknowledged may become bus-off
            return;
        }
        state_ = kind;
        ++count.faults;
        transmitter_.purge(count);
        recovery.fault();
    }
    void purge() noexcept TAPPET_REALTIME { transmitter_.purge(count); }

    /// Returns whether this device sends the frame's identifier.
    [[nodiscard]] bool ours(const Frame& frame) const noexcept TAPPET_REALTIME {
        return index_of({frame.id, frame.extended}) < transmit_.size();
    }
    /// Returns true when no frame is queued or unconfirmed.
    [[nodiscard]] bool all_is_sent() const noexcept TAPPET_REALTIME {
        return !faulted(state_) && transmitter_.waiting() == 0 && transmitter_.in_flight() == 0;
    }
    [[nodiscard]] std::size_t waiting() const noexcept TAPPET_REALTIME { return transmitter_.waiting(); }
    /// Returns whether at least one of `parts` equal parts of the limit is in flight: 1 means all, 2 half.
    [[nodiscard]] bool is_filled(std::size_t parts) const noexcept TAPPET_REALTIME {
        return transmitter_.is_filled(parts);
    }
    [[nodiscard]] Duration confirm_within() const noexcept TAPPET_REALTIME {
        return transmitter_.confirm_within();
    }
    [[nodiscard]] std::size_t in_flight() const noexcept TAPPET_REALTIME { return transmitter_.in_flight(); }
    [[nodiscard]] State state() const noexcept TAPPET_REALTIME { return state_; }
    [[nodiscard]] Time next_timeout() const noexcept TAPPET_REALTIME {
        return faulted(state_) ? never : transmitter_.next_timeout();
    }

    Counters count{};
    Recovery recovery{};

private:
    Send refuse(Send why) noexcept TAPPET_REALTIME {
        ++count.refused;
        return why;
    }
    /// Returns the identifier's index; the size when this device does not send it.
    [[nodiscard]] std::size_t index_of(Identifier of) const noexcept TAPPET_REALTIME {
        std::size_t at = 0;
        while (at < transmit_.size() && transmit_[at] != of) ++at;
        return at;
    }
    Transmitter transmitter_{};
    std::span<const Identifier> transmit_{};
    bool takes_fd_ = false;
    std::array<Duration, TransmitQueue::capacity> longest_{}; // of transmit_, from making to confirmation
    std::array<Confirmation, TransmitQueue::capacity> last_{};
    State state_ = State::active;
};

/// Common part of real and simulated devices: the calls that their controller answers.
class ControlledDevice : public Device {
public:
    using Device::send;
    Send send(const Frame& frame, Keep keep) noexcept TAPPET_REALTIME final {
        belongs_to_.used();
        return controller_.accept(frame, keep);
    }
    [[nodiscard]] Time next_service() const noexcept TAPPET_REALTIME override {
        return controller_.next_timeout();
    }
    [[nodiscard]] State state() const noexcept TAPPET_REALTIME final { return controller_.state(); }
    [[nodiscard]] Counters counters() const noexcept TAPPET_REALTIME final { return controller_.count; }
    [[nodiscard]] Duration longest_response(Identifier of) const noexcept TAPPET_REALTIME final {
        return controller_.longest_response(of);
    }
    [[nodiscard]] Confirmation last_confirmed(Identifier of) const noexcept TAPPET_REALTIME final {
        return controller_.last_confirmed(of);
    }
    void purge() noexcept TAPPET_REALTIME final { controller_.purge(); }

protected:
    Controller controller_{};
};

} // namespace tappet::can

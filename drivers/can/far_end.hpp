// The other end of a CAN bus: the nodes in a machine's signal map.
#pragma once

#include "drivers/can/device.hpp"
#include "drivers/can/node_signals.hpp"
#include "drivers/twin/far_end.hpp"
#include "kernel/base/array_of.hpp"

#include <array>
#include <cstdint>

namespace tappet::can {

/// Raw frames, for a plant that builds its own.
class RawFarEnd : public FarEndOf<Device> {
public:
    RawFarEnd(FarEnds& of, std::string_view device) : FarEndOf{of, device, "can"} {}

    /// Takes the machine's next frame. Returns false when there is none.
    bool receive(Frame& frame) noexcept {
        for (Receive got = wire_->receive(frame); got.what != Received::none; got = wire_->receive(frame))
            if (got.what == Received::frame) return true;
        return false;
    }
    /// Sends a frame. Returns false, and counts it, when the bus refuses the frame.
    bool send(const Frame& frame) noexcept {
        const Send sent = wire_->send(frame, Keep::every);
        const bool taken = sent == Send::queued || sent == Send::replaced;
        refused_ += taken ? 0u : 1u;
        return taken;
    }

    void give(Time now) override { wire_->service(now); }
    [[nodiscard]] Time next() const noexcept override { return wire_->next_service(); }
};

/// Access by the names of the map, which the compiler checks:
///     can.get("drive_command.speed")      the last value the machine sent, in the signal's unit; 0 before
///     can.came("drive_command")           whether it arrived since the plant's last move()
///     can.set("drive.speed", 12.5)        is sent with the next frame "drive"
///     can.send("drive")                   sends it in this move()
///     can.send_every("encoder", 1ms)      sends it periodically; 0: stops
template <const auto& map>
class FarEnd final : public RawFarEnd, public NodeSignals<map> {
    using Signals = NodeSignals<map>;
    using Signals::nodes;
    using Signals::store_;

public:
    using typename Signals::Received;
    using typename Signals::Sent;

    using RawFarEnd::RawFarEnd;

    [[nodiscard]] bool came(Received frame) const noexcept { return came_[frame.index]; }

    using RawFarEnd::send;
    void send(Sent frame) noexcept { wanted_[frame.index] = true; }
    void send_every(Sent frame, Duration period) noexcept {
        every_[frame.index] = period;
        due_[frame.index] = period > Duration::zero() ? now_ : never;
    }

    void take(Time now) override {
        now_ = now;
        came_ = {};
        Frame frame;
        while (receive(frame)) {
            std::size_t f = no_such;
            if (store_.decode(frame, f) == Decoded::yes) came_[f] = true;
        }
    }
    void give(Time now) override {
        for (std::size_t f = 0; f < nodes.frames.size(); ++f) {
            const bool is_due = every_[f] > Duration::zero() && due_[f] <= now;
            if (wanted_[f] || is_due) static_cast<void>(RawFarEnd::send(store_.encode(f, now)));
            wanted_[f] = false;
            if (is_due) due_[f] += ((now - due_[f]) / every_[f] + 1) * every_[f];
        }
        RawFarEnd::give(now);
    }
    [[nodiscard]] Time next() const noexcept override {
        Time next = RawFarEnd::next();
        for (const Time due : due_) next = due < next ? due : next;
        return next;
    }

private:
    std::array<bool, nodes.frames.size()> came_{};
    std::array<bool, nodes.frames.size()> wanted_{};
    std::array<Duration, nodes.frames.size()> every_{};
    std::array<Time, nodes.frames.size()> due_ =
        array_of<nodes.frames.size()>([](std::size_t) { return never; });
    Time now_{};
};

} // namespace tappet::can

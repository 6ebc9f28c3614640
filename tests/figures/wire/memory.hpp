// A controller without a wire: the frames of one end stay in memory until the program carries them to the
// other. Both ours and the bare program use it.
#pragma once

#include "drivers/can/device.hpp"

#include <array>

namespace tappet::figures {

class Memory final : public can::Device {
public:
    static constexpr std::size_t capacity = 64;

    using Device::send;
    can::Receive receive(can::Frame& frame) noexcept TAPPET_REALTIME override {
        if (taken_ == arrived_) return {};
        frame = inbox_[taken_++ % capacity];
        return {can::Received::frame, 0};
    }
    can::Send send(const can::Frame& frame, can::Keep) noexcept TAPPET_REALTIME override {
        if (sent - fetched_ == capacity) return can::Send::refused_full;
        outbox_[sent++ % capacity] = frame;
        return can::Send::queued;
    }
    void service(Time) noexcept TAPPET_REALTIME override {}
    bool finish(Time) noexcept TAPPET_REALTIME override { return true; } // what is sent has left
    [[nodiscard]] Time next_service() const noexcept TAPPET_REALTIME override { return never; }
    [[nodiscard]] can::State state() const noexcept TAPPET_REALTIME override { return can::State::active; }
    [[nodiscard]] can::Counters counters() const noexcept TAPPET_REALTIME override { return {}; }
    void purge() noexcept TAPPET_REALTIME override {}
    can::Restart restart() noexcept override { return can::Restart::not_needed; }
    [[nodiscard]] bool wakes(os::Waiter&) noexcept override { return true; }

    // ---- the other side

    /// Returns false when there is none.
    bool fetch(can::Frame& frame) noexcept {
        if (fetched_ == sent) return false;
        frame = outbox_[fetched_++ % capacity];
        return true;
    }
    void arrive(const can::Frame& frame) noexcept { inbox_[arrived_++ % capacity] = frame; }
    void bring_to(Memory& other) noexcept {
        for (can::Frame frame; fetch(frame);) other.arrive(frame);
    }

    std::size_t sent = 0;

private:
    std::array<can::Frame, capacity> inbox_{}, outbox_{};
    std::size_t taken_ = 0, arrived_ = 0, fetched_ = 0;
};

} // namespace tappet::figures

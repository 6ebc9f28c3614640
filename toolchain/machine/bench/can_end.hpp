// The plant's end of a CAN bus on the bench: a raw SocketCAN socket that never blocks the plant's loop.
#pragma once

#include "drivers/can/device.hpp"
#include "drivers/can/signal_map.hpp"
#include "kernel/base/text.hpp"

#include <expected>

namespace tappet {

/// Sends at once, whoever acknowledges. Not real-time.
class CanEnd final : public can::Device {
public:
    CanEnd() = default;
    ~CanEnd() override;

    /// The other end of `machine`. The error says what is wrong and how to cure it.
    std::expected<void, Sentence> open(std::string_view interface, const can::Identifiers& machine);
    /// Tells every listener of error frames that the bus is off.
    void announce_bus_off();

    using Device::send;
    can::Receive receive(can::Frame& frame) noexcept TAPPET_REALTIME override;
    can::Send send(const can::Frame& frame, can::Keep keep) noexcept TAPPET_REALTIME override;
    void service(Time) noexcept TAPPET_REALTIME override {}
    bool finish(Time) noexcept TAPPET_REALTIME override { return true; } // what is sent has left
    [[nodiscard]] Time next_service() const noexcept TAPPET_REALTIME override { return never; }
    [[nodiscard]] can::State state() const noexcept TAPPET_REALTIME override { return can::State::active; }
    [[nodiscard]] can::Counters counters() const noexcept TAPPET_REALTIME override { return count_; }
    void purge() noexcept TAPPET_REALTIME override {}
    can::Restart restart() noexcept override { return can::Restart::not_needed; }
    [[nodiscard]] bool wakes(os::Waiter& waiter) noexcept override { return waiter.watch(socket_); }

private:
    int socket_ = -1;
    can::Counters count_{};
};

} // namespace tappet

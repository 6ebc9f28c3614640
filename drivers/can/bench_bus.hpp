// The plant's end of a CAN bus on the bench: a raw SocketCAN socket that never blocks the plant's loop.
#pragma once

#include "drivers/can/device.hpp"
#include "drivers/can/kind.hpp"
#include "drivers/twin/bench_end.hpp"

namespace tappet::can {

/// Sends at once, even without an acknowledgement. Not real-time.
class BenchBus final : public BenchEnd, public Device {
public:
    static constexpr const DeviceKind& kind = device_kind;

    BenchBus() = default;
    ~BenchBus() override;

    std::expected<void, Sentence> open(const DevicePlace& place) override;
    ProvidedDevice provided(std::string_view name) noexcept override { return provide<Device>(name, *this); }
    /// Sends a bus-off error frame to every listener of error frames.
    void announce_bus_off() override;
    [[nodiscard]] std::uint64_t unsent() const noexcept override { return count_.refused; }

    using Device::send;
    Receive receive(Frame& frame) noexcept TAPPET_REALTIME override;
    Send send(const Frame& frame, Keep keep) noexcept TAPPET_REALTIME override;
    void service(Time) noexcept TAPPET_REALTIME override {}
    bool finish(Time) noexcept TAPPET_REALTIME override { return true; } // frames sent have already left
    [[nodiscard]] Time next_service() const noexcept TAPPET_REALTIME override { return never; }
    [[nodiscard]] State state() const noexcept TAPPET_REALTIME override { return State::active; }
    [[nodiscard]] Counters counters() const noexcept TAPPET_REALTIME override { return count_; }
    void purge() noexcept TAPPET_REALTIME override {}
    Restart restart() noexcept override { return Restart::not_needed; }
    [[nodiscard]] bool wakes(os::Waiter& waiter) noexcept override { return waiter.watch(socket_); }

private:
    int socket_ = -1;
    Counters count_{};
};

} // namespace tappet::can

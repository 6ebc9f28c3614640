// A CAN interface of the box.
#pragma once

#include "drivers/can/safe_sender.hpp"
#include "drivers/can/signal_map.hpp"
#include "drivers/can/socket_can.hpp"
#include "kernel/component/real_device.hpp"

namespace tappet::can {

/// Opened for the identifiers of its driver's signal map.
class RealBus final : public RealDevice {
public:
    static constexpr const DeviceKind& kind = device_kind;

    std::expected<void, Sentence> open(const DevicePlace& place) override;
    ProvidedDevice provided(std::string_view name) noexcept override { return provide<Device>(name, bus_); }
    void report(os::ArmingReport& report, std::string_view name) override;
    void count(WireCounters& into) const noexcept override { bus_.counters().tell(into); }
    std::expected<void, Sentence> prepare_safe_ending() override;
    void begin_safe_frames() noexcept override { safe_.begin(); }
    void send_safe_frames() noexcept override { safe_.send(SafeSender::Purpose::earnest); }
    std::size_t safe_frames_left() noexcept override { return safe_.left(); }

private:
    SocketCan bus_{};
    SafeSender safe_{}; // opened in the guardian's process only
    std::string_view address_{};
    std::span<const Frame> safe_frames_{};
};

} // namespace tappet::can

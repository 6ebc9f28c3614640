// A Modbus server, reached over Ethernet or a serial port of the box.
#pragma once

#include "drivers/modbus/libmodbus_transport.hpp"
#include "drivers/modbus/register_map.hpp"
#include "kernel/component/real_device.hpp"

namespace tappet::modbus {

class RealServer final : public RealDevice {
public:
    static constexpr const DeviceKind& kind = device_kind;

    std::expected<void, Sentence> open(const DevicePlace& place) override;
    ProvidedDevice provided(std::string_view name) noexcept override {
        return provide<Transport>(name, server_);
    }
    void report(os::ArmingReport& report, std::string_view name) override;
    [[nodiscard]] bool has_safe_requests() const noexcept override { return true; }
    bool make_safe_requests(Time end, const Meanwhile& meanwhile) noexcept override;

private:
    LibmodbusTransport server_{};
    const SafeWrites* safe_ = nullptr;
    std::string_view address_{};
    bool is_serial_ = false;
};

} // namespace tappet::modbus

// A port of this box that receives datagrams, or one of another box that is asked.
#pragma once

#include "drivers/udp/socket.hpp"
#include "kernel/component/real_device.hpp"

namespace tappet::udp {

class RealPort final : public RealDevice {
public:
    static constexpr const DeviceKind& kind = device_kind;

    std::expected<void, Sentence> open(const DevicePlace& place) override;
    ProvidedDevice provided(std::string_view name) noexcept override {
        return provide<Device>(name, socket_);
    }

private:
    Socket socket_{};
};

} // namespace tappet::udp

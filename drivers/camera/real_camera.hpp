// A camera of the box.
#pragma once

#include "drivers/camera/video.hpp"
#include "kernel/component/real_device.hpp"

namespace tappet::camera {

/// It has no outputs, so the guardian has nothing to make safe.
class RealCamera final : public RealDevice {
public:
    static constexpr const DeviceKind& kind = device_kind;

    std::expected<void, Sentence> open(const DevicePlace& place) override;
    ProvidedDevice provided(std::string_view name) noexcept override;
    void count(WireCounters& into) const noexcept override { video_.counters().tell(into); }

private:
    Video video_{};
};

} // namespace tappet::camera

// A GPIO chip of the box.
#pragma once

#include "drivers/gpio/lines.hpp"
#include "kernel/component/real_device.hpp"

namespace tappet::gpio {

/// Opens the chip for the lines of its driver's line map, each at the binding's offset.
class RealChip final : public RealDevice {
public:
    static constexpr const DeviceKind& kind = device_kind;

    std::expected<void, Sentence> open(const DevicePlace& place) override;
    ProvidedDevice provided(std::string_view name) noexcept override { return provide<Device>(name, chip_); }
    void count(WireCounters& into) const noexcept override { chip_.counters().tell(into); }
    [[nodiscard]] int kept_by_guardian() const noexcept override { return chip_.wait_handle(); }
    std::expected<void, Sentence> prepare_safe_ending() override;
    bool write_safe_lines() noexcept override { return chip_.make_safe(); }

private:
    std::string_view address_{};
    Lines chip_{};
    PlacedLines lines_{};
};

} // namespace tappet::gpio

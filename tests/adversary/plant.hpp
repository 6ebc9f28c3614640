// The other end of the test bench's wires: a level that rises and falls, whatever the machine does.
#pragma once

#include "drivers/can/far_end.hpp"
#include "drivers/gpio/far_end.hpp"
#include "drivers/modbus/far_end.hpp"
#include "drivers/plant/plant.hpp"
#include "kernel/base/random.hpp"
#include "tests/adversary/maps.hpp"

namespace adversary {

class Plant final : public tappet::Plant {
public:
    explicit Plant(std::uint64_t seed) : random_{seed} { can.send_every("level", 5ms); }

    Time move(Time now) override {
        height_ = std::clamp(height_ + (random_.unit() - 0.5), 0.0, 100.0);
        can.set("level.height", height_);
        can.set("level.weight", 0.4 * height_);
        io.set("full", height_ > 50.0);
        unit.set("oven.temperature", 20.0 + unit.get("heat.power"));
        if (!std::exchange(flows_, true)) unit.set("meter.flow", 0.5); // a fault's value stays
        return now + 5ms;
    }

    can::FarEnd<bed_signals> can{ends, "bed-can"};
    gpio::FarEnd<bed_lines> io{ends, "bed-io"};
    modbus::FarEnd<bed_registers> unit{ends, "bed-unit"};

private:
    Random random_;
    double height_ = 50.0;
    bool flows_ = false;
};

} // namespace adversary

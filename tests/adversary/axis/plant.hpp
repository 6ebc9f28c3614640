// A servo drive, and somebody who turns its shaft by hand while it has no power.
#pragma once

#include "drivers/can/far_end.hpp"
#include "drivers/canopen/simulated_servo.hpp"
#include "drivers/plant/plant.hpp"
#include "kernel/base/random.hpp"
#include "tests/adversary/axis/machine.hpp"

namespace adversary_axis {

class Plant final : public tappet::Plant {
public:
    explicit Plant(std::uint64_t seed) : random_{seed} {
        can.send_every("status", 2ms);
        can.send_every("actual", 2ms);
    }

    Time move(Time now) override {
        const canopen::DriveOrder told = [this](auto order) {
            order.controlword = static_cast<std::uint16_t>(can.integer("control.word"));
            order.mode = can.integer("control.mode");
            order.position = can.get("target.position");
            order.profile_velocity = can.get("profile.velocity");
            order.velocity = can.get("target.velocity");
            order.torque = can.get("profile.torque");
            return order;
        }(canopen::DriveOrder{});
        servo_.take(told);
        servo_.step(to_seconds(step()));
        const std::uint16_t word = servo_.statusword();
        if ((word & 0x6Fu) != 0x27u && (word & 0x6Fu) != 0x07u && random_.one_in(200))
            servo_.turn_shaft(20.0 * (random_.unit() - 0.5));
        can.set_integer("status.word", word);
        can.set_integer("status.mode", static_cast<std::uint64_t>(servo_.mode()));
        can.set("actual.position", servo_.position());
        can.set("actual.velocity", servo_.velocity());
        return now + 2ms;
    }

    can::FarEnd<axis_signals> can{ends, "axis-can"};

private:
    Random random_;
    canopen::SimulatedServo servo_{};
};

} // namespace adversary_axis

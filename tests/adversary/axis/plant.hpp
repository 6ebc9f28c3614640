// A servo drive as slow and forgetful as CiA 402 allows, and a person who turns its shaft by hand while it
// has no power.
#pragma once

#include "drivers/can/far_end.hpp"
#include "drivers/canopen/simulated_servo.hpp"
#include "drivers/plant/plant.hpp"
#include "kernel/base/random.hpp"
#include "tests/adversary/axis/machine.hpp"

#include <array>

namespace adversary_axis {

class Plant final : public tappet::Plant {
public:
    explicit Plant(std::uint64_t seed) : random_{seed} {
        can.send_every("status", 2ms);
        can.send_every("actual", 2ms);
        hears_late_by_ = any_trip();
        answers_late_by_ = any_trip();
        servo_.faults.knows_no_halt_in_cyclic = random_.one_in(2);
        servo_.faults.remembers_home = random_.one_in(2);
        servo_.faults.mode_steps = random_.one_in(2) ? 0 : static_cast<int>(random_.between(1, 60));
        servo_.set_home(40.0 * (random_.unit() - 0.5));
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
        told_[moves_ % trips] = told;
        servo_.take(told_[(moves_ + trips - hears_late_by_) % trips]);
        servo_.step(to_seconds(step()));
        const std::uint16_t word = servo_.statusword();
        if ((word & 0x6Fu) != 0x27u && (word & 0x6Fu) != 0x07u && random_.one_in(200))
            servo_.turn_shaft(20.0 * (random_.unit() - 0.5));
        says_[moves_ % trips] = {word, servo_.mode(), servo_.position(), servo_.velocity()};
        const Says& says = says_[(moves_ + trips - answers_late_by_) % trips];
        can.set_integer("status.word", says.word);
        can.set_integer("status.mode", static_cast<std::uint64_t>(says.mode));
        can.set("actual.position", says.position);
        can.set("actual.velocity", says.velocity);
        ++moves_;
        return now + 2ms;
    }

    can::FarEnd<axis_signals> can{ends, "axis-can"};

private:
    struct Says {
        std::uint16_t word = 0;
        std::int64_t mode = 0;
        double position = 0, velocity = 0;
    };
    static constexpr std::size_t trips = 26; // steps of 2 ms from one end of the wire to the other, and back

    std::size_t any_trip() { return random_.one_in(2) ? 0 : random_.below(trips); }

    Random random_;
    std::array<canopen::DriveOrder, trips> told_{};
    std::array<Says, trips> says_{};
    std::size_t moves_ = 0, hears_late_by_ = 0, answers_late_by_ = 0;
    canopen::SimulatedServo servo_{};
};

} // namespace adversary_axis

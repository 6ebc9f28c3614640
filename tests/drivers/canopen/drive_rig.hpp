// A drive as an axis and a simulated one, with frames between them that take some cycles each way.
#pragma once

#include "drivers/canopen/simulated_servo.hpp"

#include <deque>
#include <limits>

namespace tappet::canopen {

struct DriveRig {
    static constexpr double dt = 0.001;

    void cycle() {
        feedback.push_back({true, servo.statusword(), servo.mode(), servo.position(), servo.velocity()});
        while (feedback.size() > cycles_in + 1) feedback.pop_front();
        DriveFeedback seen = feedback.front();
        seen.heard = heard;
        seen.passed = 1ms;
        if (says_nonsense) seen.position = std::numeric_limits<double>::quiet_NaN();
        orders.push_back(axis.step(seen));
        last = orders.back();
        while (orders.size() > cycles_out) {
            if (hears) servo.take(orders.front());
            orders.pop_front();
        }
        servo.step(dt);
        ++cycles;
    }
    void run(int count) {
        for (int i = 0; i < count; ++i) cycle();
    }
    /// False: it did not happen within five seconds.
    template <class Condition> bool until(Condition condition) {
        for (int i = 0; i < 5000; ++i) {
            if (condition()) return true;
            cycle();
        }
        return condition();
    }
    bool reaches(motion::AxisMode state) {
        return until([&] { return axis.state() == state; });
    }
    bool gets_power() {
        axis.power(true);
        return reaches(motion::AxisMode::standstill);
    }

    DriveMotion axis;
    SimulatedServo servo;
    std::size_t cycles_in = 2, cycles_out = 2;
    bool heard = true; ///< the axis hears the drive
    bool hears = true; ///< the drive hears the axis
    bool says_nonsense = false;
    DriveOrder last;
    int cycles = 0;
    std::deque<DriveFeedback> feedback;
    std::deque<DriveOrder> orders;
};

} // namespace tappet::canopen

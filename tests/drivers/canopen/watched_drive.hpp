// A drive whose motor is checked in each cycle: it never turns faster than requested.
#pragma once

#include "tests/drivers/canopen/drive_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tappet::canopen {

/// It never turns faster than the last request, or than before.
struct Watched : DriveRig {
    void is(int there, int back, bool knows_halt, int mode_steps,
            OperationMode boots_in = OperationMode::none) {
        cycles_out = static_cast<std::size_t>(there);
        cycles_in = static_cast<std::size_t>(back);
        servo.faults.knows_no_halt_in_cyclic = !knows_halt;
        servo.faults.mode_steps = 0;
        servo.take({.mode = static_cast<std::int64_t>(boots_in)});
        servo.faults.mode_steps = mode_steps;
    }
    /// The drive hears of a replacing motion only after the handshakes of both.
    void ask(double speed) {
        expire(3 * round_trip() + servo.faults.mode_steps + 20);
        asked = speed;
    }
    bool move_to(double place, double speed) {
        if (!axis.move_to(place, speed)) return false;
        ask(speed);
        return true;
    }
    bool go_home() {
        if (!axis.home()) return false;
        ask(20);
        return true;
    }
    bool comes_to(motion::AxisMode state) {
        return watched_until([&] { return axis.state() == state; });
    }
    void ask_rest() { expire(static_cast<int>(cycles_out) + 1); }
    [[nodiscard]] int round_trip() const { return static_cast<int>(cycles_in + cycles_out) + 1; }

    void watched_cycle() {
        const motion::AxisMode before = axis.state();
        const double speed_before = std::abs(servo.velocity());
        cycle();
        const motion::AxisMode after = axis.state();
        if (after != before &&
            (after == motion::AxisMode::disabled || after == motion::AxisMode::standstill ||
             after == motion::AxisMode::error_stop))
            ask_rest();
        std::erase_if(old, [&](const Old& one) { return one.until < cycles; });
        double most = std::max(asked, speed_before);
        for (const Old& one : old) most = std::max(most, one.speed);
        const double speed = std::abs(servo.velocity());
        if (speed > most + 1e-6 && breaches++ == 0)
            ADD_FAILURE() << "cycle " << cycles << ": turns at " << speed << ", asked for at most " << most
                          << "; axis " << to_text(after) << ", drive's mode " << servo.mode()
                          << ", order: mode " << last.mode << ", word " << std::hex << last.controlword
                          << std::dec << ", position " << last.position << " of " << servo.position();
        if (after == motion::AxisMode::standstill && axis.stands() && speed > 1e-3 && breaches++ == 0)
            ADD_FAILURE() << "cycle " << cycles << ": said to stand, and turns at " << speed;
    }
    template <class Condition> bool watched_until(Condition condition) {
        for (int i = 0; i < 5000 && !condition(); ++i) watched_cycle();
        return condition();
    }
    void watched_run(int count) {
        for (int i = 0; i < count; ++i) watched_cycle();
    }

    struct Old {
        double speed;
        int until;
    };
    double asked = 0;
    std::vector<Old> old;
    int breaches = 0;

private:
    void expire(int after) {
        if (asked > 0) old.push_back({asked, cycles + after});
        asked = 0;
    }
};

} // namespace tappet::canopen

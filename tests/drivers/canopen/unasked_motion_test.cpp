// An axis moves only as requested, whatever happens to its drive, its frames and its shaft.
#include "kernel/base/random.hpp"
#include "tests/drivers/canopen/watched_drive.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>

namespace tappet::canopen {
namespace {

using motion::AxisMode;
using enum OperationMode;

constexpr std::array boot_modes{none,   profile_position, profile_velocity, profile_torque,
                                homing, cyclic_position,  cyclic_velocity,  cyclic_torque};

/// Sends any request at any time, to a drive to which anything happens.
struct Anybody : Watched {
    explicit Anybody(std::uint64_t seed) : random{seed} {
        const auto trip = random.between(0, 49);
        const auto there = random.between(0, trip);
        const bool knows_halt = random.one_in(2);
        const auto mode_steps = random.one_in(2) ? 0 : random.between(1, 60);
        const OperationMode boots_in = boot_modes[random.below(boot_modes.size())];
        is(static_cast<int>(there), static_cast<int>(trip - there), knows_halt, static_cast<int>(mode_steps),
           boots_in);
        servo.faults.remembers_home = random.one_in(2);
        servo.set_home(random.unit() * 20 - 10);
    }
    void live(int count) {
        for (int i = 0; i < count && breaches == 0; ++i) {
            if (quiet > 0)
                --quiet; // lets a motion end
            else if (random.one_in(patience))
                ask_anything();
            if (random.one_in(1000)) patience = std::array{8u, 60u, 500u}[random.below(3)];
            if (random.one_in(200)) recover();
            if (random.one_in(10 * patience)) befall_anything();
            if (turns_by != 0) servo.turn(turns_by);
            if (loss > 0 && --loss == 0) heard = hears = true;
            says_nonsense = random.one_in(20000);
            lead_positions();
            const AxisMode before = axis.state();
            watched_cycle();
            if (before != axis.state()) judge_end(before);
        }
    }
    void ask_anything() {
        const double speed = 2 + 78 * random.unit();
        const double place = 100 * random.unit() - 50;
        const auto what = random.below(16);
        const bool is_motion = what >= 6 && what != 14;
        if (what != 0 && what != 1 && what != 5 && what != 14) place_asked.reset(), homings_before.reset();
        switch (what) {
        case 0: axis.power(true); break;
        case 1:
            if (!random.one_in(3)) break;
            axis.power(false);
            ask_rest();
            break;
        case 2: axis.reset(); break;
        case 3:
            if (axis.halt()) ask_rest();
            break;
        case 4:
            if (axis.stop()) ask_rest();
            break;
        case 5: axis.release(); break;
        case 6:
        case 7:
            if (go_home()) homings_before = servo.homings();
            break;
        case 8:
        case 9:
            if (move_to(place, speed)) place_asked = place;
            break;
        case 10:
            if (axis.move_at(place)) ask(std::abs(place));
            break;
        case 11:
            if (axis.synchronize(cyclic_position)) {
                ask(0);
                pace = 0.5 * place;
                beside = 0;
                is_led = false;
            }
            break;
        case 12:
            if (axis.synchronize(cyclic_velocity)) {
                ask(speed);
                axis.follow(speed);
            }
            break;
        case 13:
            if (axis.synchronize(cyclic_torque)) {
                ask(100);
                axis.follow(place);
            }
            break;
        case 14: axis.follow(random.one_in(2) ? std::nan("") : HUGE_VAL); break;
        case 15:
            if (axis.state() == AxisMode::standstill) {
                if (axis.superimpose(place, speed, 500)) ask(speed);
            } else if (axis.superimpose(place, speed, 500)) {
                EXPECT_EQ(axis.state(), AxisMode::synchronized_motion);
                beside = std::max(beside, speed); // the previous motion may have to slow down first
                ask(std::abs(pace) + beside);
            }
            break;
        default: break;
        }
        if (is_motion) ++motions;
        if (random.one_in(20)) quiet = static_cast<int>(random.below(2000));
    }
    void recover() {
        if (axis.state() == AxisMode::error_stop) axis.reset();
        if (axis.state() == AxisMode::disabled) axis.power(true);
        if (axis.state() == AxisMode::stopping) axis.release();
    }
    void befall_anything() {
        switch (random.below(9)) {
        case 0: servo.trip(); break;
        case 1: servo.stop_quickly(); break;
        case 2: servo.lose_power(); break;
        case 3:
        case 4: turns_by = random.one_in(3) ? 0 : 0.1 * random.unit() - 0.05; break;
        case 5: // its frames are lost
            heard = false;
            loss = static_cast<int>(random.between(1, 200));
            break;
        case 6: // both ways, which the drive takes for a fault
            heard = hears = false;
            loss = static_cast<int>(random.between(1, 200));
            servo.trip();
            break;
        case 7: { // its node restarts, which takes longer than frames are in flight
            heard = hears = false;
            loss = 300;
            const SimulatedServo::Faults faults = servo.faults;
            servo = SimulatedServo{};
            servo.faults.mode_steps = 0;
            servo.take({.mode = static_cast<std::int64_t>(boot_modes[random.below(boot_modes.size())])});
            servo.faults = faults;
            servo.turn(random.unit());
            homings_before.reset();
            break;
        }
        case 8: // frames take another time; in cyclic position a frame that arrives with the next one
                // would be a jump
            if (last.mode == 8 || servo.mode() == 8) break;
            cycles_in = random.below(26);
            cycles_out = random.below(26);
            for (Old& one : old) one.until += 60;
            break;
        default: break;
        }
    }
    /// Positions at a constant speed, from the position where following began.
    void lead_positions() {
        if (axis.state() != AxisMode::synchronized_motion) is_led = false;
        if (!axis.follows() || last.mode != 8) return;
        if (!is_led) {
            is_led = true;
            led = last.position;
            ask(std::abs(pace) + beside);
        }
        axis.follow(led += pace * dt);
    }
    void judge_end(AxisMode before) {
        if (axis.state() == AxisMode::standstill && before == AxisMode::homing && homings_before) {
            ++homings;
            EXPECT_GT(servo.homings(), *homings_before) << "done, and it never was; cycle " << cycles;
        }
        if (axis.state() == AxisMode::standstill && before == AxisMode::discrete_motion && place_asked &&
            servo.state() == DriveState::operation_enabled) { // otherwise someone may have turned it since
            ++places;
            EXPECT_NEAR(servo.position(), *place_asked, 1e-6) << "done, and is elsewhere; cycle " << cycles;
        }
        place_asked.reset();
        homings_before.reset();
    }

    Random random;
    unsigned patience = 150;
    bool is_led = false;
    double turns_by = 0, pace = 0, led = 0, beside = 0;
    int loss = 0, quiet = 0, motions = 0, homings = 0, places = 0;
    std::optional<double> place_asked;
    std::optional<int> homings_before;
};

TEST(AnyAxis, never_moves_unrequested_or_faster_than_requested) {
    const std::uint64_t first = std::random_device{}();
    int motions = 0, homings = 0, places = 0;
    for (std::uint64_t seed = first; seed < first + 200 && !testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Anybody somebody{seed};
        somebody.live(20000);
        motions += somebody.motions;
        homings += somebody.homings;
        places += somebody.places;
    }
    EXPECT_GT(motions, 1000);
    EXPECT_GT(homings, 20);
    EXPECT_GT(places, 20) << "else it shows little";
}

} // namespace
} // namespace tappet::canopen

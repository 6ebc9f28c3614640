// The carpet loom on the host under virtual time, as a test sees it: it runs until a condition holds, and
// gives the state, its reason, and the plant's report of the run.
#pragma once

// Includes the components but not the table: on_host() of the machine's library holds that, compiled once.
#include "apps/carpet_loom/loom.hpp"
#include "apps/carpet_loom/main_drive.hpp"
#include "apps/carpet_loom/main_shaft.hpp"
#include "apps/carpet_loom/network.hpp"
#include "apps/carpet_loom/warp_tension.hpp"
#include "apps/carpet_loom/weft_insertion.hpp"
#include "drivers/canopen/manager.hpp"
#include "tests/apps/carpet_loom/loom_run.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>

namespace tappet::carpet {

using CanBus = can::Bus<can_signals, canopen::frames<loom_network>>;
using Network = canopen::Manager<loom_network>;

/// Only the test causes faults, and only the test presses buttons.
inline loom::Settings nobody_there() { return {.operator_present = false}; }

/// The seeds of a suite, each another plant. The real-time sanitizer checks code paths and is twelve times
/// slower: it runs the first seed only, since the others take the same paths.
inline auto seeds(std::uint64_t number) {
#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
    number = 1;
#endif
#endif
    return testing::Range<std::uint64_t>(1, number + 1);
}

class LoomRig {
public:
    /// By default only the test causes faults; the operator is at work.
    explicit LoomRig(std::uint64_t seed, const loom::Settings& settings = {})
        : run_{std::make_unique<LoomRun>(settings, seed)} {
        const auto started = run_->start();
        EXPECT_TRUE(started) << started.error().view();
    }
    ~LoomRig() { run_->stop(); }
    LoomRig(const LoomRig&) = delete;
    LoomRig& operator=(const LoomRig&) = delete;

    void run_for(Duration time) { static_cast<void>(run_->run_for(time)); }
    /// Checks every millisecond. Returns false when `limit` passed first.
    template <class Condition>
    bool run_until(Condition condition, Duration limit) {
        for (const Time end = now() + limit; now() < end; run_for(1ms))
            if (condition()) return true;
        return condition();
    }
    bool run_until_state(std::string_view wanted, Duration limit) {
        return run_until([&] { return state() == wanted; }, limit);
    }
    bool run_until_angle(double deg) {
        return run_until(
            [&] {
                const double angle = std::fmod(plant().position_deg(), 360.0);
                return angle >= deg && angle < deg + 8.0;
            },
            1s);
    }
    bool run_until_it_stands(Duration limit) {
        return run_until([&] { return plant().speed_rpm() == 0.0; }, limit);
    }
    /// Stops an activity of the machine for that long.
    void hang(std::string_view activity, Duration time) {
        run().world().hang(find_activity(run().instance().machine().table, activity), now() + time);
    }
    /// Buttons by hand, for a loom whose operator is away: each is pressed as long as a hand presses it.
    void acknowledge() { press(loom::Button::acknowledge); }
    void press(loom::Button button) {
        plant().press(button, 100ms);
        run_for(110ms);
    }
    /// Unlocks the loom by hand after a start, and prepares it.
    bool prepare() {
        run_for(500ms); // its nodes boot
        acknowledge();
        return run_until_state("ready", 5s);
    }
    /// Prepares the loom, starts it by hand, and weaves some picks.
    bool weave_by_hand() {
        if (!prepare()) return false;
        press(loom::Button::start);
        return run_until([&] { return state() == "weave" && plant().picks() > 5; }, 5s);
    }
    /// Prepares the loom, lets the operator start it, and weaves some picks.
    bool weave(std::uint64_t picks = 5) {
        const std::uint64_t wanted = plant().picks() + picks;
        return run_until([&] { return state() == "weave" && plant().picks() >= wanted; }, 30s);
    }

    [[nodiscard]] Time now() { return run_->now(); }
    [[nodiscard]] std::string_view state() {
        const auto path = execution().path();
        return path.empty() ? std::string_view{} : path[path.size() - 1];
    }
    /// The reason of the last transition that gave one.
    [[nodiscard]] std::string_view reason() { return execution().reason(); }
    [[nodiscard]] const StateMachineExecution& execution() {
        return *run_->instance().state_machine_of("loom");
    }

    template <class T>
    [[nodiscard]] T& component(std::string_view name) {
        return *run_->instance().find<T>(name);
    }
    /// Explains the state when a test expected another one.
    [[nodiscard]] std::string told() {
        return "in state " + std::string{state()} + ": " + std::string{reason()};
    }
    [[nodiscard]] StopCause cause() { return component<Loom>("loom").cause.last(); }
    [[nodiscard]] LoomRun& run() { return *run_; }
    [[nodiscard]] can::TwinBus& bus() { return run_->devices().bus("loom-can"); }
    [[nodiscard]] can::Twin& machine_can() { return run_->devices().controller("loom-can"); }
    [[nodiscard]] gpio::Twin& lines() { return run_->devices().lines("loom-io"); }
    [[nodiscard]] modbus::Twin& utility() { return run_->devices().server("loom-utility"); }
    [[nodiscard]] loom::Plant& plant() { return run_->plant(); }
    [[nodiscard]] loom::Report report() { return plant().report(); }
    /// The level of the machine's output line with this offset, as on the wire.
    [[nodiscard]] bool output(unsigned offset) { return (lines().outputs() >> line_index(offset) & 1u) != 0; }
    /// Index in the twin's lines, by the wire's offset.
    [[nodiscard]] static std::size_t line_index(unsigned offset) {
        namespace line = wires::line;
        constexpr std::array<unsigned, 12> offsets{
            line::emergency_stop, line::drop_wire,          line::weft_detector, line::button_start,
            line::button_stop,    line::button_acknowledge, line::weft_release,  line::brake,
            line::lamp_run,       line::lamp_stop,          line::lamp_fault,    line::yarn_cutter};
        for (std::size_t i = 0; i < offsets.size(); ++i)
            if (offsets[i] == offset) return i;
        ADD_FAILURE() << "no line of offset " << offset;
        return 0;
    }

private:
    std::unique_ptr<LoomRun> run_;
};

/// Expects every stop for a weft or a warp end within the tolerance of the stop angle.
inline void expect_stops_in_tolerance(const loom::Report& report) {
    for (const loom::Stop& stop : report.stops) {
        const bool is_guided = stop.cause == loom::StopCause::weft || stop.cause == loom::StopCause::warp ||
                               stop.cause == loom::StopCause::operator_stop;
        if (!is_guided) continue;
        EXPECT_LE(std::abs(stop.error_deg), wires::nominal::stop_tolerance_deg)
            << "seed " << report.seed << ": a stop by " << name_of(stop.cause) << " at pick " << stop.at_pick
            << " stood at " << stop.angle_deg << " deg";
    }
}

inline void expect_no_damage(const loom::Report& report) {
    const loom::Damage& damage = report.damage;
    EXPECT_EQ(damage.total(), 0u) << "seed " << report.seed << ": closed_shed_wefts "
                                  << damage.closed_shed_wefts << ", double_wefts " << damage.double_wefts
                                  << ", late_wefts " << damage.late_wefts << ", valve_after_emergency "
                                  << damage.valve_after_emergency << ", tension_high " << damage.tension_high
                                  << ", tension_low " << damage.tension_low << ", moved_unpowered "
                                  << damage.moved_unpowered << ", motor_blocked " << damage.motor_blocked
                                  << ", ran_dry " << damage.ran_dry;
}

} // namespace tappet::carpet

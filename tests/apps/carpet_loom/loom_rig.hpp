// The carpet loom on the host under virtual time, as a test sees it: run until something is so, ask for the
// state and its reason, and what the plant says of the run.
#pragma once

// The components, and not the table: on_host() of the machine's library holds that, compiled once.
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

/// Only what a test asks for goes wrong, and nobody presses a button but the test.
inline loom::Settings nobody_there() { return {.operator_present = false}; }

/// The seeds of a suite, each another plant. Under the real-time sanitizer, which looks at the ways that the
/// code takes and is twelve times slower, the first: the others take the same ways.
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
    /// By default only what a test asks for goes wrong; the operator is at work.
    explicit LoomRig(std::uint64_t seed, const loom::Settings& settings = {})
        : run_{std::make_unique<LoomRun>(settings, seed)} {
        const auto started = run_->start();
        EXPECT_TRUE(started) << started.error().view();
    }
    ~LoomRig() { run_->stop(); }
    LoomRig(const LoomRig&) = delete;
    LoomRig& operator=(const LoomRig&) = delete;

    void run_for(Duration time) { static_cast<void>(run_->run_for(time)); }
    /// Looks every millisecond. False when `limit` passed first.
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
    /// An activity of the machine runs nothing for so long.
    void hang(std::string_view activity, Duration time) {
        run().world().hang(find_activity(run().instance().machine().table, activity), now() + time);
    }
    /// By hand, for a loom whose operator is away: its buttons, as long as a hand presses them.
    void acknowledge() { press(loom::Button::acknowledge); }
    void press(loom::Button button) {
        plant().press(button, 100ms);
        run_for(110ms);
    }
    /// Unlocked by hand after a start, and prepared.
    bool prepare() {
        run_for(500ms); // its nodes boot
        acknowledge();
        return run_until_state("ready", 5s);
    }
    /// The same, started by hand and some picks on its way.
    bool weave_by_hand() {
        if (!prepare()) return false;
        press(loom::Button::start);
        return run_until([&] { return state() == "weave" && plant().picks() > 5; }, 5s);
    }
    /// Prepared, started by the operator, and some picks on its way.
    bool weave(std::uint64_t picks = 5) {
        const std::uint64_t wanted = plant().picks() + picks;
        return run_until([&] { return state() == "weave" && plant().picks() >= wanted; }, 30s);
    }

    [[nodiscard]] Time now() { return run_->now(); }
    [[nodiscard]] std::string_view state() {
        const auto path = execution().path();
        return path.empty() ? std::string_view{} : path[path.size() - 1];
    }
    /// Of the last transition that gave one.
    [[nodiscard]] std::string_view reason() { return execution().reason(); }
    [[nodiscard]] const StateMachineExecution& execution() {
        return *run_->instance().state_machine_of("loom");
    }

    template <class T>
    [[nodiscard]] T& component(std::string_view name) {
        return *run_->instance().find<T>(name);
    }
    /// Why it is in this state, for who expected another one.
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
    /// The machine's output line of this offset, as it is on the wire.
    [[nodiscard]] bool output(unsigned offset) { return (lines().outputs() >> line_index(offset) & 1u) != 0; }
    /// Of the twin's lines, by the wire's offset.
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

/// Every stop for a weft or a warp end within the tolerance of the stop angle.
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

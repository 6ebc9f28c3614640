// The rules of the carpet loom's swarm: what must never happen, whatever goes wrong around the loom, and when
// it weaves.
#pragma once

#include "apps/carpet_loom/console.hpp"
#include "apps/carpet_loom/loom.hpp"
#include "apps/carpet_loom/main_drive.hpp"
#include "apps/carpet_loom/plant.hpp"
#include "toolchain/machine/swarm_rules.hpp"

namespace tappet::carpet {

class Swarm final : public SwarmRules {
public:
    Swarm(MachineInstance& machine, Plant& plant, const Struck& struck)
        : machine_{machine}, plant_{plant.loom()}, struck_{struck}, loom_{*machine.find<Loom>("loom")} {
        machine.find<Console>("console")->quiet.set(true);
        const auto number = [&](std::string_view name) {
            return find_component(machine.machine().table, name);
        };
        io_ = number("io");
        logic_ = number("loom");
        weft_ = number("weft");
        watch_ = number("shaft_dog");
        states_watch_ = number("logic_dog");
        for (const auto name : {"can", "main", "motion_dog", "last_resort"})
            static_cast<void>(leads_.push(number(name)));
        damage_ = plant_.damage();
    }

    std::string_view broken(Time now) override {
        namespace line = wires::line;
        const LoomState state = loom_.state.last();
        if (state != state_) {
            state_ = state;
            since_ = now;
            picks_ = plant_.picks();
        }
        const bool valve = plant_.output(line::weft_release), brake = plant_.output(line::brake);
        const bool opens = valve && !valve_, braked = brake_;
        valve_ = valve;
        brake_ = brake;
        const loom::Damage damage = damage_;
        damage_ = plant_.damage();
        if (damage_.closed_shed_wefts != damage.closed_shed_wefts)
            return "a weft is released into a closed shed";
        if (damage_.double_wefts != damage.double_wefts) return "a second weft is released into one shed";
        if (damage_.late_wefts != damage.late_wefts) return "a weft is caught by the closing shed";
        if (damage_.motor_blocked != damage.motor_blocked) return "the motor is driven against the brake";
        if (damage_.ran_dry != damage.ran_dry) return "the loom runs without oil";
        if (opens && braked) return "a weft is released while the drive is stopping";

        const Duration whole = struck_.whole_for(io_, now), settled = std::min(now - since_, whole);
        if (weaves(state) || now - since_ < reaction || whole < taken_up) return blind(now);
        if (valve) return "the weft's valve is open while the loom stands";
        if (promises_brake(state) && !brake) return "the brake is off in a state that promises it";
        const Duration watched =
            std::min(struck_.whole_for(watch_, now), struck_.whole_for(leads_[leads_.size() - 1], now));
        if (std::min(settled, std::max(watched, struck_.whole_for(weft_, now))) >= stops_within &&
            plant_.output(line::yarn_cutter))
            return "the yarn cutter is driven while the loom stands";
        if (settled >= stops_within && brake && plant_.speed_rpm() != 0.0)
            return "the shaft turns against its brake";
        if (std::min(settled, led_for(now)) >= stops_within && plant_.main_drive().target() != 0 &&
            plant_.main_drive().power() == loom::Power::follow)
            return "the main drive is driven while the loom stands";
        return blind(now);
    }
    bool works() override { return state_ == LoomState::weave && plant_.picks() >= picks_ + 5; }
    std::string_view waits_for() override {
        const WaitsFor what = loom_.waits_for.last();
        return what == WaitsFor::nothing || what == WaitsFor::acknowledgement ? "" : name_of(what);
    }
    Sentence trouble(Random& random, Duration lasts) override {
        constexpr std::array<std::string_view, 9> names{
            "a weft breaks",         "a warp end breaks",         "a node is silent",
            "a drive trips",         "the oil is lost",           "the oil level is low",
            "the feeder runs empty", "the emergency stop is hit", "stop is pressed"};
        const std::size_t which = random.below(names.size());
        loom::ScriptedFault fault{.fault = static_cast<loom::Fault>(which), .lasts = lasts};
        const bool of_drive = fault.fault == loom::Fault::drive_fault;
        fault.node = static_cast<std::uint8_t>(1 + random.below(of_drive ? 2 : wires::node::count));
        if (random.one_in(3)) fault.lasts = {}; // until the operator repairs it
        plant_.inject(fault);
        Sentence text{names[which]};
        if (of_drive || fault.fault == loom::Fault::node_lost) text.add(": node ").add(int{fault.node});
        return text.add(fault.lasts == Duration{} ? ", until repaired" : "");
    }
    [[nodiscard]] SwarmPeople people() const override { return {properties, ports, scripts}; }

private:
    static constexpr Duration reaction = 5ms;         // from a state to its promised line levels
    static constexpr Duration taken_up = 25ms;        // writes that a chip refused, once it is back
    static constexpr Duration stops_within = 500ms;   // a shaft at speed, by its brake
    static constexpr Duration noticed_within = 300ms; // loss of the state machine, until standstill
    static constexpr bool weaves(LoomState state) {
        return state == LoomState::run_up || state == LoomState::weave || state == LoomState::stopping;
    }
    static constexpr bool promises_brake(LoomState state) {
        return state == LoomState::locked || state == LoomState::emergency || state == LoomState::fault ||
               state == LoomState::safe;
    }
    // Properties that describe the construction of brake, beam and encoder are left to experts.
    static constexpr std::array<std::string_view, 9> properties{
        "main.speed_rpm",   "main.slip_for", "shaft.stop_angle_deg", "shaft.learning_rate", "shaft.late_deg",
        "warp.set_point_n", "warp.band_n",   "loom.colour",          "record.shift"};
    static constexpr std::array<std::string_view, 16> ports{
        "io.lamp_run",       "io.lamp_stop",        "loom.lamp_fault",    "loom.feeder_colour",
        "loom.feeder_speed", "weft.pattern",        "loom.drop_wire",     "loom.tension_in_band",
        "loom.main_fault",   "loom.main_slips",     "loom.let_off_fault", "main.velocity",
        "warp.measured",     "network.silent_node", "console.speed_rpm",  "shaft.stop_error_deg"};
    static constexpr std::array<SwarmScript, 3> scripts{
        {{"weft", "twill.osd",
          "StateMachine Twill {"
          " initial state First { entry { do weft.lift(4369); } transition shaft.beat_up() select Second }"
          " state Second { entry { do weft.lift(8738); } transition shaft.beat_up() select First }"
          " final state Carpet { entry { do weft.weave_carpet(); } } }"},
         {"weft", "running_out.osd", // fails in its trial: no harness is left
          "StateMachine RunningOut { var int harnesses = 16;"
          " initial state Even { entry { do weft.lift(harnesses); set harnesses = harnesses / 4; }"
          " transition shaft.beat_up() select Odd }"
          " state Odd { entry { do weft.lift(harnesses); set harnesses = harnesses / 4; }"
          " transition shaft.beat_up() select Even }"
          " final state Carpet { entry { do weft.weave_carpet(); } } }"},
         {"weft", "faulty.osd",
          "StateMachine Faulty {"
          " initial state First { entry { do weft.lft(4369); } transition shaft.beat_up() select Carpet }"
          " final state Carpet { entry { do weft.weave_carpet(); } } }",
          false}}};

    /// Returns how long all parts between the states and the main drive have been intact.
    [[nodiscard]] Duration led_for(Time now) const {
        Duration least = Duration::max();
        for (const std::size_t each : leads_) least = std::min(least, struck_.whole_for(each, now));
        return least;
    }
    /// Without its state machine, the remaining components must stop the loom.
    std::string_view blind(Time now) {
        // A hanging activity is noticed only once somebody needs it.
        const bool rests = machine_.life().state_of(logic_) == ComponentState::running &&
                           !machine_.engines()[machine_.machine().index.activity[logic_]].is_woken();
        if (struck_.whole_for(logic_, now) >= Duration{} || rests) seen_at_ = now;
        const Duration left = std::min({now - seen_at_, struck_.whole_for(io_, now),
                                        struck_.whole_for(states_watch_, now), led_for(now)});
        return left >= noticed_within && plant_.speed_rpm() != 0.0
                   ? "the shaft turns without the loom's states"
                   : "";
    }

    MachineInstance& machine_;
    loom::Plant& plant_;
    const Struck& struck_;
    Loom& loom_;
    std::size_t io_ = 0, logic_ = 0, weft_ = 0, watch_ = 0, states_watch_ = 0;
    Bounded<std::size_t, 4> leads_{};
    LoomState state_ = LoomState::off;
    Time since_{}, seen_at_{};
    std::uint64_t picks_ = 0;
    bool valve_ = false, brake_ = true;
    loom::Damage damage_{};
};

} // namespace tappet::carpet

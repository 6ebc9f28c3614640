// A machine just large enough to weave on the plant: it uses only frames and lines, on a 1 ms cycle.
#pragma once

#include "apps/carpet_loom/plant/plant.hpp"
#include "tests/apps/carpet_loom/plant/machine_side.hpp"

#include <vector>

namespace tappet::loom {

class SmallMachine {
public:
    enum class State { prepare, ready, running, stopping, stopped };

    SmallMachine(const Settings& settings, std::uint64_t seed) : plant(settings, seed) {}

    void run_until(Time end) {
        for (; now < end; now += 1ms) cycle();
    }
    template <class Condition> bool run_while(Condition condition, Duration at_most) {
        for (const Time end = now + at_most; now < end; now += 1ms) {
            if (!condition()) return true;
            cycle();
        }
        return !condition();
    }

    Plant plant;
    Time now{};
    State state = State::prepare;
    double distance_deg = wires::nominal::brake_distance_deg;
    double tension_n = 0.0;
    bool releases = true;      // give the weft its release
    bool holds_tension = true; // run the tension loop
    bool speaks = true;        // send process data
    bool checks_weft = true;   // stop when it is missing
    bool repeats_pattern = false;
    std::vector<double> arrivals_deg; // estimated shaft angle of each arrival
    std::vector<double> arrival_speeds_rpm;
    std::uint16_t main_status = 0;
    std::uint16_t let_off_status = 0;
    std::vector<std::uint16_t> emergencies;
    std::uint64_t frames = 0;

private:
    void cycle() {
        plant.advance(now);
        for (can::Frame frame; plant.transmit(frame);) take(frame);
        Edge edge;
        while (plant.next_edge(edge)) take(edge);
        think();
        if (speaks) send();
        if (releases) cam();
    }

    void take(const can::Frame& frame) {
        ++frames;
        if (frame.id > canopen::cob::emergency && frame.id < canopen::cob::emergency + 16)
            emergencies.push_back(static_cast<std::uint16_t>(emergency_of(frame).code));
        const std::string_view name = wire.take(frame);
        if (frame.id > canopen::cob::heartbeat && NmtState{frame.data[0]} == NmtState::boot_up)
            for (const can::Frame& each :
                 start(static_cast<std::uint8_t>(frame.id - canopen::cob::heartbeat)))
                plant.receive(each, now);
        if (name == "main_drive") {
            main_status = static_cast<std::uint16_t>(wire.integer(name, "statusword"));
            const double rpm = static_cast<double>(wire.integer(name, "velocity")) / 10.0;
            acceleration = (rpm - speed_rpm) * 6.0 / 0.002;
            speed_rpm = rpm;
        }
        if (name == "let_off") let_off_status = static_cast<std::uint16_t>(wire.integer(name, "statusword"));
        if (name == "encoder") {
            const auto code = static_cast<double>(wire.integer(name, "position"));
            angle_deg = (code + 0.5) * 360.0 / wires::encoder_codes_per_turn;
            angle_at = frame.stamp;
        }
        if (name == "load_cell") tension_n = static_cast<double>(wire.integer(name, "tension")) / 10.0;
    }

    double angle_at_time(Time t) const {
        const double dt = to_seconds(t - angle_at);
        return angle_deg + (speed_rpm * 6.0 + 0.5 * acceleration * dt) * dt;
    }

    void take(const Edge& edge) {
        namespace line = wires::line;
        if (edge.line == line::emergency_stop && edge.level && state != State::stopped) {
            brake(now);
            quick = true;
            plant.set_line(line::weft_release, false, now);
            state = State::stopping;
        }
        if (!edge.level) return;
        if (edge.line == line::weft_detector) {
            arrived = true;
            arrivals_deg.push_back(angle_of_position(angle_at_time(edge.at)));
            arrival_speeds_rpm.push_back(speed_rpm);
        }
        if (edge.line == line::drop_wire || edge.line == line::button_stop)
            stop_wanted = state == State::running;
        if (edge.line == line::button_start && state == State::ready) {
            plant.set_line(line::brake, false, now);
            state = State::running;
            released = true; // no weft before the first turn has begun
            arrived = true;
            stop_wanted = false;
            run_at = now + 15ms;
        }
        if (edge.line == line::button_acknowledge && state == State::stopped &&
            !plant.line(line::emergency_stop)) {
            state = State::prepare;
            quick = false;
        }
    }

    void brake(Time at) {
        plant.set_line(wires::line::brake, true, at);
        state = State::stopping;
        still_since = never;
    }

    void think() {
        const double angle = angle_of_position(angle_at_time(now));
        if (state == State::prepare && (main_status & 0x6F) == 0x27 && (let_off_status & 0x6F) == 0x27 &&
            std::abs(tension_n - 300.0) < 30.0)
            state = State::ready;
        if (state == State::running) {
            if (angle < 30.0) released = arrived = false;
            if (angle > 200.0) plant.set_line(wires::line::weft_release, false, now);
            if (checks_weft && releases && angle > wires::nominal::weft_window_end_deg && angle < 300.0 &&
                released && !arrived)
                stop_wanted = true;
            const double part = speed_rpm / wires::nominal::speed_rpm;
            const double dead = speed_rpm * 6.0 * 0.008;
            const double distance = dead + (distance_deg - 28.8) * part * part;
            const double left = wires::nominal::stop_deg - distance - angle;
            if (stop_wanted && speed_rpm > 60.0 && left < speed_rpm * 6.0 * 0.001 &&
                left > -speed_rpm * 6.0 * 0.001) {
                const double in_s = std::max(0.0, left / (speed_rpm * 6.0));
                brake(now + Duration{static_cast<std::int64_t>(in_s * 1e9)});
                learns = part > 0.95;
            }
        }
        if (state == State::stopping && speed_rpm == 0.0) {
            if (still_since == never) still_since = now;
            if (now - still_since > 20ms) {
                const double error = wrapped_deg(angle_deg - wires::nominal::stop_deg);
                if (!quick && learns) distance_deg += 0.7 * error;
                state = State::stopped;
            }
        }
        plant.set_line(wires::line::lamp_run, state == State::running, now);
        plant.set_line(wires::line::lamp_stop, state == State::ready, now);
        plant.set_line(wires::line::lamp_fault, state == State::stopped, now);
    }

    static std::uint16_t controlword(std::uint16_t status, bool reset) {
        if ((status & 0x4F) == 0x08) return reset ? 0x80 : 0x00;
        if ((status & 0x4F) == 0x40) return 0x06;
        return (status & 0x6F) == 0x21 ? 0x07 : 0x0F;
    }

    void send() {
        const bool reset = state == State::prepare && now.time_since_epoch() % 10ms < 5ms;
        const double rpm = state == State::running && now >= run_at ? wires::nominal::speed_rpm : 0.0;
        plant.receive(
            wire.frame("main_drive_command", {{"controlword", quick ? 0x02 : controlword(main_status, reset)},
                                              {"velocity", static_cast<std::int32_t>(rpm * 10.0)}}),
            now);
        const double error = tension_n - wires::nominal::tension_n;
        if (holds_tension) integral = clamp_to(integral + 0.02 * error * 0.001, 0.2);
        const double forward = speed_rpm * wires::nominal::pick_spacing_mm /
                               (2.0 * 3.14159265 * wires::nominal::beam_radius_mm); // rpm of the beam
        const double beam_rpm = holds_tension ? forward + 0.004 * error + integral : 0.0;
        plant.receive(wire.frame("let_off_command", {{"controlword", controlword(let_off_status, reset)},
                                                     {"velocity", round_to_int(beam_rpm * 1000.0)}}),
                      now);
        if (now.time_since_epoch() % 100ms == 0ms)
            plant.receive(wire.frame("feeder_command", {{"colour", 1}, {"speed", 1500}}), now);
        const std::int64_t pick = plant.dobby().taken() + 1;
        if (!repeats_pattern && now.time_since_epoch() % 10ms == 0ms)
            plant.receive(wire.frame("dobby_command", {{"pick", pick}, {"pattern", pick}}), now);
        if (now == Time{} + 100ms) plant.climate().set_pump(true);
    }

    void cam() {
        if (state != State::running || released || speed_rpm < 60.0) return;
        const double speed = speed_rpm * 6.0;
        const double angle = angle_of_position(angle_at_time(now));
        const double dead_s = to_seconds(wires::nominal::weft_release_dead);
        double in_s = (wires::nominal::weft_release_deg - angle) / speed;
        for (int i = 0; i < 3; ++i)
            in_s = (wires::nominal::weft_release_deg - angle) / (speed + 0.5 * acceleration * in_s);
        in_s -= dead_s;
        if (in_s > 0.001 || angle > wires::nominal::weft_release_deg) return;
        released = true;
        plant.set_line(wires::line::weft_release, true,
                       now + Duration{static_cast<std::int64_t>(std::max(0.0, in_s) * 1e9)});
    }

    MachineSide wire;
    double angle_deg = 0.0;
    Time angle_at{};
    double speed_rpm = 0.0;
    double acceleration = 0.0;
    double integral = 0.0;
    bool released = false;
    bool arrived = false;
    bool stop_wanted = false;
    bool quick = false;
    bool learns = false;
    Time still_since = never;
    Time run_at{};
};

} // namespace tappet::loom

// Simulates the slide with its drive, a bearing in the bore of its housing, and the people at the machine.
#pragma once

#include "apps/bearing_press/loops.hpp"
#include "apps/bearing_press/maps.hpp"
#include "drivers/can/far_end.hpp"
#include "drivers/canopen/simulated_drive.hpp"
#include "drivers/gpio/far_end.hpp"
#include "drivers/instruments/simulated.hpp"
#include "drivers/plant/plant.hpp"
#include "kernel/base/random.hpp"

#include <bit>
#include <cmath>

namespace bearing_press {

/// The operator switches on, starts homing, and starts a bearing whenever the lamp is lit and the slide
/// stands still. The bore is as stiff as the table assumes; each bearing lies at a slightly different place.
class Plant final : public tappet::Plant {
public:
    explicit Plant(std::uint64_t seed) : random_{seed} {
        can.send_every("axis", 1ms);
        can.send_every("cell", 1ms);
        place_ = 0.01 + 0.08 * random_.unit();
        next_bearing();
    }

    Time move(Time now) override {
        const double dt = to_seconds(step());
        can.set_integer("axis.statusword", drive_.follow(can.integer("command.controlword")));
        const double asked = drive_.is_enabled() ? can.get("command.velocity") : 0.0;
        const double lag = drive_.is_enabled() ? drive_lag_s : brake_lag_s;
        const double before = speed_;
        speed_ += (asked - speed_) * std::min(1.0, dt / lag);
        place_ += (before + speed_) / 2 * dt;
        worst_speed_ = std::max(worst_speed_, std::abs(speed_));
        if (dt > 0.0 && drive_.is_enabled())
            worst_jolt_ = std::max(worst_jolt_, std::abs(speed_ - before) / dt);
        const double force = stiffness * std::max(0.0, place_ - bearing_);
        worst_force_ = std::max(worst_force_, force);
        if (force > 0.98 * seat_force) is_seated_ = true;
        if (is_seated_ && place_ < bearing_ - 0.05) { // the slide is up again: the next bearing is put in
            ++bearings_;
            next_bearing();
        }
        can.set_integer("axis.position", encoder_.count(place_));
        can.set("cell.force", force + (random_.unit() - 0.5));
        io.set("home", place_ < zero_);
        io.set("upper_end", place_ < -0.005);
        io.set("lower_end", end_ || place_ > 0.3);
        operate();
        return now + 1ms;
    }

    [[nodiscard]] bool is_done() const override { return bearings_ >= wanted && std::abs(speed_) < 1e-4; }
    [[nodiscard]] Duration usual_time() const override { return 30s; }
    [[nodiscard]] Sentence fault() const override {
        if (bearings_ < wanted) return Sentence{"only ", bearings_, " bearings were seated"};
        if (worst_force_ > 1.02 * seat_force)
            return Sentence{"a bearing was pressed by more than 2 % too much"};
        if (worst_speed_ > 1.1 * slide.velocity) return Sentence{"the slide was faster than it may be"};
        if (worst_jolt_ > most_jolt) return Sentence{"the slide was jolted"};
        return {};
    }
    [[nodiscard]] std::uint64_t digest() const override { return std::bit_cast<std::uint64_t>(place_); }
    void report(JsonText& json) const override {
        json.field("bearings", bearings_)
            .field("worst_force_N", worst_force_)
            .field("worst_speed_m_s", worst_speed_);
    }

    // For tests: actions of people, and faults.
    void press(std::string_view button, bool pressed) {
        if (button == "stop") stop_ = pressed;
        if (button == "up") up_ = pressed;
        if (button == "down") down_ = pressed;
    }
    void work(bool works) { operator_works_ = works; }
    void hold_lower_end(bool active) { end_ = active; }
    void silence_drive() { can.send_every("axis", Duration::zero()); }
    void forget_jolts() { worst_jolt_ = 0.0; }
    [[nodiscard]] double place() const { return place_ - zero_; }
    [[nodiscard]] double speed() const { return speed_; }
    [[nodiscard]] double worst_speed() const { return worst_speed_; }
    [[nodiscard]] double worst_force() const { return worst_force_; }
    [[nodiscard]] double worst_jolt() const { return worst_jolt_; } ///< m/s2
    [[nodiscard]] std::int64_t bearings() const { return bearings_; }

    static constexpr double stiffness = 2.0e6;                    // N/m
    static constexpr double seat_force = 2000.0;                  // N
    static constexpr double most_jolt = 2.2 * slide.acceleration; // m/s2: the inner level's plus 10 %
    static constexpr std::int64_t wanted = 3;

private:
    can::FarEnd<can_signals> can{ends, "axis-can"};
    gpio::FarEnd<io_lines> io{ends, "panel-io"};

    static constexpr double drive_lag_s = 0.004, brake_lag_s = 0.02, zero_ = 0.05, switched_on_at = 0.037;

    /// Presses start repeatedly while the slide stands still and bearings are wanted.
    void operate() {
        const Duration t = elapsed() % 400ms;
        const bool starts = operator_works_ && bearings_ < wanted && std::abs(speed_) < 1e-3;
        io.set("start", starts && t > 200ms && t < 300ms);
        io.set("stop", stop_);
        io.set("up", up_);
        io.set("down", down_);
    }
    void next_bearing() {
        bearing_ = zero_ + 0.195 + 0.01 * random_.unit();
        is_seated_ = false;
    }

    Random random_;
    canopen::SimulatedDrive drive_;
    instruments::SimulatedEncoder<32> encoder_{1e6, switched_on_at};
    double place_ = 0.0, speed_ = 0.0, bearing_ = 0.0;
    bool is_seated_ = false, stop_ = false, up_ = false, down_ = false, end_ = false, operator_works_ = true;
    double worst_force_ = 0.0, worst_speed_ = 0.0, worst_jolt_ = 0.0;
    std::int64_t bearings_ = 0;
};

} // namespace bearing_press

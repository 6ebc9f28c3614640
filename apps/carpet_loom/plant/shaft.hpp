// The main shaft with its motor and its brake: torques in, position out, exact within each step of
// integration.
#pragma once

#include "apps/carpet_loom/plant/drive.hpp"
#include "apps/carpet_loom/plant/shapes.hpp"
#include "kernel/base/random.hpp"

namespace tappet::loom {

/// The electromagnetic brake: dead time after each edge, linearly rising and falling torque, wear, and some
/// variation from stop to stop.
class Brake {
public:
    Brake(double wear_per_stop, Random& random) noexcept TAPPET_REALTIME : wear_per_stop_(wear_per_stop) {
        const double dead = 0.9 + 0.2 * random.unit();
        dead_ = Duration{round_to_int(dead * static_cast<double>(wires::nominal::brake_dead.count()))};
        full_torque_nm_ *= 0.9 + 0.2 * random.unit();
    }
    void set(bool on, Time now) noexcept TAPPET_REALTIME {
        if (on == on_) return;
        on_ = on;
        effect_at_ = now + dead_;
    }
    [[nodiscard]] bool on() const noexcept TAPPET_REALTIME { return on_; }
    [[nodiscard]] bool at_rest() const noexcept TAPPET_REALTIME { return torque_nm_ == (on_ ? full() : 0.0); }
    [[nodiscard]] double torque_nm() const noexcept TAPPET_REALTIME { return torque_nm_; }

    void step(Time now, double dt_s) noexcept TAPPET_REALTIME {
        if (now < effect_at_) return;
        const double change = full_torque_nm_ * (dt_s / rise_s);
        torque_nm_ = on_ ? std::min(full(), torque_nm_ + change) : std::max(0.0, torque_nm_ - change);
    }
    /// Call once per stop from speed: the lining wears, and the next stop differs slightly.
    void wear(Random& random) noexcept TAPPET_REALTIME {
        worn_ = std::min(0.15, worn_ + wear_per_stop_);
        variation_ = 0.98 + 0.04 * random.unit();
    }

private:
    static constexpr double rise_s = 0.002;
    [[nodiscard]] double full() const noexcept TAPPET_REALTIME {
        return full_torque_nm_ * (1.0 - worn_) * variation_;
    }

    double full_torque_nm_ = 3900.0;
    double wear_per_stop_;
    double worn_ = 0.0;
    double variation_ = 1.0;
    double torque_nm_ = 0.0;
    bool on_ = false;
    Duration dead_{};
    Time effect_at_{};
};

/// Motor, inertia, friction and the cyclic load of the sley. Positions are in degrees from the turn in which
/// the loom began.
class MainShaft {
public:
    static constexpr double torque_limit_nm = 90.0;
    static constexpr double speed_limit_rad_s = 900.0 * rad_s_per_rpm;
    static constexpr double nominal_inertia_kg_m2 = 0.6;

    explicit MainShaft(Random& random) noexcept TAPPET_REALTIME {
        inertia_kg_m2_ = nominal_inertia_kg_m2 * (0.8 + 0.4 * random.unit());
        coulomb_nm_ = 8.0 + 4.0 * random.unit();
        position_deg_ = 305.0 + 10.0 * random.unit(); // parked near the level of the harnesses
    }

    /// Sets the acceleration of the step that begins now and lasts dt.
    void begin_step(Power power, double target_rad_s, double brake_nm, double dt_s) noexcept TAPPET_REALTIME;
    /// Advances to the end of the step. Returns true when the shaft came to a standstill in it.
    bool end_step() noexcept TAPPET_REALTIME;

    [[nodiscard]] double position_deg() const noexcept TAPPET_REALTIME { return position_deg_; }
    [[nodiscard]] double position_deg_at(double into_step_s) const noexcept TAPPET_REALTIME {
        const double t = std::min(into_step_s, moving_s_);
        return position_deg_ + (speed_rad_s_ + 0.5 * acceleration_ * t) * t * deg_per_rad;
    }
    [[nodiscard]] double speed_rad_s_at(double into_step_s) const noexcept TAPPET_REALTIME {
        return into_step_s >= moving_s_ && stops_ ? 0.0 : speed_rad_s_ + acceleration_ * into_step_s;
    }
    [[nodiscard]] double speed_rad_s() const noexcept TAPPET_REALTIME { return speed_rad_s_; }
    [[nodiscard]] bool standing() const noexcept TAPPET_REALTIME {
        return speed_rad_s_ == 0.0 && acceleration_ == 0.0;
    }
    [[nodiscard]] bool saturated() const noexcept TAPPET_REALTIME { return saturated_; }
    /// Returns the time into the last step at which the shaft came to a standstill.
    [[nodiscard]] double stopped_into_s() const noexcept TAPPET_REALTIME { return moving_s_; }

private:
    [[nodiscard]] double motor_nm(Power power, double target_rad_s, double dt_s) noexcept TAPPET_REALTIME;

    double inertia_kg_m2_ = nominal_inertia_kg_m2;
    double coulomb_nm_ = 10.0;
    double position_deg_ = 310.0;
    double speed_rad_s_ = 0.0;
    double acceleration_ = 0.0; // rad/s^2, constant while the step moves
    double dt_s_ = 0.0;
    double moving_s_ = 0.0; // the part of the step that moves
    double integral_nm_ = 0.0;
    bool stops_ = false;
    bool saturated_ = false;
};

} // namespace tappet::loom

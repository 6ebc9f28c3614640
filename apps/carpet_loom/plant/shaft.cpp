// Integration of the main shaft: constant acceleration within a step, standstill found exactly.
#include "apps/carpet_loom/plant/shaft.hpp"

namespace tappet::loom {
namespace {

constexpr double proportional_nm_s = 40.0; // gains of the drive's velocity loop
constexpr double integral_nm_per_rad = 400.0;
constexpr double static_over_coulomb = 1.5;
constexpr double stick_rad_s = 0.02;
constexpr double viscous_nm_s = 0.14;
constexpr double sley_nm = 12.0; // load of the sley's inertia at nominal speed
constexpr double nominal_rad_s = wires::nominal::speed_rpm * rad_s_per_rpm;

} // namespace

double MainShaft::motor_nm(Power power, double target_rad_s, double dt_s) noexcept TAPPET_REALTIME {
    saturated_ = false;
    if (power != Power::follow) integral_nm_ = 0.0;
    if (power == Power::off) return 0.0;
    if (power == Power::stop)
        return speed_rad_s_ > 0.0 ? -torque_limit_nm : speed_rad_s_ < 0.0 ? torque_limit_nm : 0.0;
    const double error = clamp_to(target_rad_s, speed_limit_rad_s) - speed_rad_s_;
    const double wanted = proportional_nm_s * error + integral_nm_;
    const double torque = clamp_to(wanted, torque_limit_nm);
    saturated_ = torque != wanted;
    if (!saturated_) integral_nm_ += integral_nm_per_rad * error * dt_s;
    return torque;
}

void MainShaft::begin_step(Power power, double target_rad_s, double brake_nm, double dt_s) noexcept
    TAPPET_REALTIME {
    dt_s_ = dt_s;
    moving_s_ = dt_s;
    stops_ = false;
    const double motor = motor_nm(power, target_rad_s, dt_s);
    if (speed_rad_s_ == 0.0) {
        const double hold = brake_nm + coulomb_nm_ * static_over_coulomb;
        acceleration_ = 0.0;
        if (motor > hold) acceleration_ = (motor - hold) / inertia_kg_m2_;
        if (motor < -hold) acceleration_ = (motor + hold) / inertia_kg_m2_;
        return;
    }
    // Static friction catches a shaft that hardly turns; without it the shaft would creep for ever under a
    // motor that holds.
    const double hold = brake_nm + coulomb_nm_ * static_over_coulomb;
    if (speed_rad_s_ < stick_rad_s && -speed_rad_s_ < stick_rad_s && motor <= hold && -motor <= hold) {
        acceleration_ = -speed_rad_s_ / dt_s;
        stops_ = true;
        return;
    }
    const double part = speed_rad_s_ / nominal_rad_s;
    const double sley = sley_nm * part * part * sine_of_turns(position_deg_ / 360.0);
    const double against =
        (speed_rad_s_ > 0.0 ? 1.0 : -1.0) * (brake_nm + coulomb_nm_) + viscous_nm_s * speed_rad_s_;
    acceleration_ = (motor + sley - against) / inertia_kg_m2_;
    const double end_speed = speed_rad_s_ + acceleration_ * dt_s;
    if ((end_speed > 0.0) == (speed_rad_s_ > 0.0) && end_speed != 0.0) return;
    stops_ = true;
    moving_s_ = -speed_rad_s_ / acceleration_;
}

bool MainShaft::end_step() noexcept TAPPET_REALTIME {
    position_deg_ = position_deg_at(dt_s_);
    speed_rad_s_ = stops_ ? 0.0 : speed_rad_s_ + acceleration_ * dt_s_;
    acceleration_ = 0.0;
    const bool stopped = stops_;
    stops_ = false;
    return stopped;
}

} // namespace tappet::loom

// The warp between beam and cloth: a spring that the take-up stretches, the let-off feeds and the shed pulls.
#pragma once

#include "apps/carpet_loom/plant/drive.hpp"
#include "apps/carpet_loom/plant/shapes.hpp"
#include "kernel/base/random.hpp"

namespace tappet::loom {

class Warp {
public:
    static constexpr double hard_high_n = 700.0; // beyond it warp ends break by the dozen
    static constexpr double hard_low_n = 30.0;   // a running loom with a slack warp catches ends in the shed

    explicit Warp(Random& random) noexcept TAPPET_REALTIME {
        stiffness_n_mm_ = 20.0 * (0.8 + 0.4 * random.unit());
        shed_mm_ = 0.9 * (0.8 + 0.4 * random.unit());
        radius_mm_ = wires::nominal::beam_radius_mm * (0.95 + 0.1 * random.unit());
        const double begin_n = 180.0 + 80.0 * random.unit();
        stretch_mm_ = begin_n / stiffness_n_mm_;
    }

    void step(Power power, double target_rad_s, double takeup_deg, double dt_s) noexcept TAPPET_REALTIME {
        if (beam_rad_s_ != 0.0 || power == Power::follow) {
            const double target = power == Power::follow ? clamp_to(target_rad_s, beam_limit_rad_s) : 0.0;
            beam_rad_s_ += clamp_to((target - beam_rad_s_) / motor_lag_s, beam_limit_rad_s2) * dt_s;
            if (power != Power::follow && beam_rad_s_ < 1e-6 && beam_rad_s_ > -1e-6) beam_rad_s_ = 0.0;
        }
        const double let_off_mm = beam_rad_s_ * radius_mm_ * dt_s;
        stretch_mm_ += takeup_deg * (wires::nominal::pick_spacing_mm / 360.0) - let_off_mm;
        stretch_mm_ = stretch_mm_ > longest_mm    ? longest_mm
                      : stretch_mm_ < -longest_mm ? -longest_mm
                                                  : stretch_mm_;
        let_off_mm_ += let_off_mm;
    }
    /// Call once a turn: the beam grows thinner by the warp that it gave.
    void thin_beam() noexcept TAPPET_REALTIME {
        radius_mm_ = std::max(
            150.0, radius_mm_ - let_off_mm_ * (warp_thickness_mm / (2.0 * 3.141592653589793)) / radius_mm_);
        let_off_mm_ = 0.0;
    }
    /// The tension at a shaft angle: harnesses are level at stop_deg and pull more as the shed opens.
    [[nodiscard]] double tension_n(double shaft_deg) const noexcept TAPPET_REALTIME {
        // (1 - cos) / 2, the cosine as a sine a quarter turn ahead.
        const double open = 0.5 - 0.5 * sine_of_turns((shaft_deg - wires::nominal::stop_deg) / 360.0 + 0.25);
        const double tension = stiffness_n_mm_ * (stretch_mm_ + shed_mm_ * open);
        return tension > 0.0 ? tension : 0.0;
    }
    [[nodiscard]] double beam_rad_s() const noexcept TAPPET_REALTIME { return beam_rad_s_; }
    [[nodiscard]] bool standing() const noexcept TAPPET_REALTIME {
        return beam_rad_s_ < 1e-4 && beam_rad_s_ > -1e-4;
    }

private:
    static constexpr double motor_lag_s = 0.012;
    static constexpr double beam_limit_rad_s = 2.0 * rad_s_per_rpm;
    static constexpr double beam_limit_rad_s2 = 20.0 * rad_s_per_rpm;
    static constexpr double warp_thickness_mm = 1.2;
    static constexpr double longest_mm = 100.0;

    double stiffness_n_mm_ = 20.0;
    double shed_mm_ = 0.9;
    double radius_mm_ = wires::nominal::beam_radius_mm;
    double stretch_mm_ = 0.0;
    double beam_rad_s_ = 0.0;
    double let_off_mm_ = 0.0; // since the beam was last thinned
};

} // namespace tappet::loom

// The let-off: a velocity drive turns the warp beam so that the warp keeps its tension. A PI controller with
// the main shaft's take-up fed forward (thesis 3.3; US4827985).
#pragma once

#include "apps/carpet_loom/drive_axis.hpp"
#include "apps/carpet_loom/wires.hpp"
#include "kernel/component/component.hpp"
#include "kernel/pieces/changed.hpp"

#include <algorithm>

namespace tappet::carpet {

namespace wires = loom::wires;

/// The gains of the tension loop.
struct TensionGains {
    Property<double> proportional{0.004};
    Property<double> integral{0.02};

    static constexpr auto interface() {
        return facets(
            property<&TensionGains::proportional>("proportional", "rpm/N", "proportional gain", range(0, 1)),
            property<&TensionGains::integral>("integral", "rpm/(N s)", "integral gain", range(0, 10)));
    }
};

/// All real-time, each cycle of a periodic activity.
struct WarpTension {
    Input<double> measured;
    Input<double> shaft_speed;
    Input<std::int64_t> statusword;
    Output<std::int64_t> controlword;
    Output<double> target;
    Output<bool> enabled;
    Output<bool> in_band;
    Output<bool> fault;
    Property<double> set_point_n{wires::nominal::tension_n};
    Property<double> band_n{wires::nominal::tension_band_n};
    TensionGains gains;
    Property<double> beam_radius_mm{wires::nominal::beam_radius_mm};

    Sentence accepts(const Proposal& proposal) const noexcept TAPPET_REALTIME {
        if (proposal.of(band_n) < proposal.of(set_point_n)) return {};
        return Sentence{"band_n reaches down to no tension at all; keep it below set_point_n"};
    }

    void enable() noexcept TAPPET_REALTIME {
        held_ = false;
        axis_.enable();
    }
    void disable() noexcept TAPPET_REALTIME { axis_.disable(); }
    /// Feeds the take-up of a shaft that still turns, and stops with it.
    void hold() noexcept TAPPET_REALTIME { held_ = true; }

    void start(const Cycle&) noexcept TAPPET_REALTIME {
        integral_rpm_ = 0.0;
        axis_.start(controlword, target);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const bool on = axis_.lead(statusword, controlword, enabled, fault);
        target.write(on ? controlled(cycle) : 0.0);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        axis_.stop(controlword, target, enabled, fault);
        in_band_.write(in_band, false);
    }

    static constexpr auto interface() {
        return facets(
            input<&WarpTension::measured>("measured", "N", "warp tension at the back rest"),
            input<&WarpTension::shaft_speed>("shaft_speed", "rpm", "of the main shaft, for the feed-forward"),
            input<&WarpTension::statusword>("statusword", "", "CiA 402 statusword of the let-off drive"),
            output<&WarpTension::controlword>("controlword", "", "CiA 402 controlword for the let-off drive"),
            output<&WarpTension::target>("target", "rpm", "target velocity of the warp beam"),
            output<&WarpTension::enabled>("enabled", "", "operation enabled; written on change"),
            output<&WarpTension::in_band>("in_band", "",
                                          "the tension is near its set point; written on change"),
            output<&WarpTension::fault>("fault", "", "the drive is faulty or silent; written on change"),
            property<&WarpTension::set_point_n>("set_point_n", "N", "warp tension wanted", range(50, 600)),
            property<&WarpTension::band_n>("band_n", "N", "how near counts as in band", range(1, 200)),
            bag<&WarpTension::gains>("gains", "of the tension's loop, changed together"),
            property<&WarpTension::beam_radius_mm>("beam_radius_mm", "mm", "of the full warp beam",
                                                   range(50, 1000)),
            operation<&WarpTension::enable>("enable", "closes the loop; resets one fault", required),
            operation<&WarpTension::disable>("disable", "opens the loop", required),
            operation<&WarpTension::hold>("hold", "feeds what the shaft takes up, nothing at stand",
                                          required));
    }

private:
    static constexpr double integral_limit_rpm = 0.2;
    static constexpr double two_pi = 6.283185307179586;

    double controlled(const Cycle& cycle) noexcept TAPPET_REALTIME {
        double tension_n = 0.0;
        const Flow flow = measured.read(tension_n);
        const double speed_rpm = known_speed();
        const double forward = speed_rpm * wires::nominal::pick_spacing_mm / (two_pi * beam_radius_mm.get());
        const bool blind = flow == Flow::stale || flow == Flow::never_written;
        const double error = tension_n - set_point_n.get();
        in_band_.write(in_band, !blind && error < band_n.get() && -error < band_n.get());
        // Only the take-up is followed: nothing is fed while the shaft stands or its speed is unknown.
        if (blind || held_) return speed_rpm > 0.0 ? forward + integral_rpm_ : 0.0;
        integral_rpm_ = std::clamp(integral_rpm_ + gains.integral.get() * error * to_seconds(cycle.period),
                                   -integral_limit_rpm, integral_limit_rpm);
        return forward + gains.proportional.get() * error + integral_rpm_;
    }

    [[nodiscard]] double known_speed() noexcept TAPPET_REALTIME {
        return shaft_speed.good() ? shaft_speed.get() : 0.0;
    }

    DriveAxis axis_{};
    bool held_ = false;
    double integral_rpm_ = 0.0;
    Changed<bool> in_band_;
};

} // namespace tappet::carpet

// A simulated shaft with a known true angle, its encoder, and error statistics: the reference for the tests
// of kernel/cam.
#pragma once

#include "kernel/base/random.hpp"
#include "kernel/base/time.hpp"
#include "kernel/cam/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace tappet::test {

/// A shaft that moves in pieces of constant acceleration; positions in degrees from zero, exact to double.
class TrueShaft {
public:
    explicit TrueShaft(double start_deg) { pieces_.push_back({0.0, start_deg, 0.0, 0.0}); }

    TrueShaft& accelerate(double acceleration_deg_s2, double for_s) {
        const Piece from = pieces_.back();
        pieces_.back().a = acceleration_deg_s2;
        pieces_.push_back({from.t + for_s, from.p + (from.v + 0.5 * acceleration_deg_s2 * for_s) * for_s,
                           from.v + acceleration_deg_s2 * for_s, 0.0});
        return *this;
    }
    TrueShaft& hold(double for_s) { return accelerate(0.0, for_s); }
    /// Changes from the present speed to `deg_s` within `for_s`.
    TrueShaft& ramp(double deg_s, double for_s) {
        accelerate((deg_s - pieces_.back().v) / for_s, for_s);
        pieces_.back().v = deg_s;
        return *this;
    }
    TrueShaft& jump(double deg_s) {
        pieces_.back().v = deg_s;
        return *this;
    }
    /// Changes from the present speed to standstill within `way_deg`.
    TrueShaft& brake(double way_deg) { return ramp(0.0, 2.0 * way_deg / std::fabs(pieces_.back().v)); }

    [[nodiscard]] double end_s() const { return pieces_.back().t; }
    [[nodiscard]] double speed(double t) const { return piece(t).v + piece(t).a * (t - piece(t).t); }
    [[nodiscard]] double degrees(double t) const {
        const Piece& p = piece(t);
        const double dt = t - p.t;
        return p.p + (p.v + 0.5 * p.a * dt) * dt;
    }

private:
    struct Piece {
        double t, p, v, a;
    };
    [[nodiscard]] const Piece& piece(double t) const {
        auto after = std::upper_bound(pieces_.begin(), pieces_.end(), t,
                                      [](double x, const Piece& p) { return x < p.t; });
        return after == pieces_.begin() ? *after : *(after - 1);
    }
    std::vector<Piece> pieces_;
};

/// The encoder's reading at a true angle.
inline std::uint32_t code_at(double degrees, std::uint32_t codes_per_turn) {
    const double turns = degrees / 360.0;
    const auto code = static_cast<std::uint32_t>((turns - std::floor(turns)) * codes_per_turn);
    return std::min(code, codes_per_turn - 1);
}

/// The distance from b to a within half a turn, in degrees.
inline double apart(double a_deg, double b_deg) {
    const double turns = (a_deg - b_deg) / 360.0;
    return (turns - std::floor(turns + 0.5)) * 360.0;
}

inline Time at_s(double s) { return at_ns(static_cast<std::int64_t>(s * 1e9 + 0.5)); }
inline double in_s(Time t) { return static_cast<double>(to_ns(t)) * 1e-9; }

/// Absolute errors and their percentiles.
class Errors {
public:
    void add(double error) { all_.push_back(std::fabs(error)); }
    [[nodiscard]] std::size_t count() const { return all_.size(); }
    [[nodiscard]] double percentile(double part) {
        if (all_.empty()) return 1e9; // a test without measurements must fail
        std::sort(all_.begin(), all_.end());
        return all_[std::min(all_.size() - 1,
                             static_cast<std::size_t>(part * static_cast<double>(all_.size())))];
    }
    [[nodiscard]] double p50() { return percentile(0.5); }
    [[nodiscard]] double p99() { return percentile(0.99); }
    [[nodiscard]] double max() { return percentile(1.0); }
    void print(const char* what) {
        std::printf("    %-58s p50 %7.4f  p99 %7.4f  max %7.4f deg (%zu)\n", what, p50(), p99(), max(),
                    count());
    }

private:
    std::vector<double> all_;
};

/// The arrival of encoder samples.
struct Sampling {
    std::uint32_t codes_per_turn = 4096;
    double period_s = 1e-3;
    double period_jitter_s = 1e-4; // the instants themselves
    double stamp_delay_s = 0.0;    // the stamp is late by up to this time, uniformly
    std::uint64_t missing_one_in = 0;
};

inline ShaftProperties properties_for(const Sampling& sampling) {
    return {.codes_per_turn = sampling.codes_per_turn,
            .stamp_latency = Duration{static_cast<std::int64_t>(sampling.stamp_delay_s * 0.5e9)},
            .stamp_jitter = Duration{static_cast<std::int64_t>(sampling.stamp_delay_s * 1e9 / 3.4641)}};
}

} // namespace tappet::test

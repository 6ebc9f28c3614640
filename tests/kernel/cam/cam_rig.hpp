// A true shaft, its encoder, the estimator and the schedule in virtual time: samples arrive, and timers fire
// exactly.
#pragma once

#include "kernel/cam/schedule.hpp"
#include "tests/kernel/cam/true_shaft.hpp"

#include <vector>

namespace tappet::test {

/// One firing with the true values.
struct Fired {
    CamEvent event;
    Time at{};
};

inline ShaftProperties patient_properties_for(const Sampling& sampling) {
    ShaftProperties p = properties_for(sampling);
    p.max_age = 8ms; // chance never loses so many samples in a row
    return p;
}

template <std::size_t N> struct CamRig {
    CamRig(const CamTable<N>& table, const TrueShaft& truth, const Sampling& how, std::uint64_t seed,
           const CamProperties& properties = {})
        : shaft(truth),
          sampling(how),
          random(seed),
          estimator(patient_properties_for(how)),
          schedule(table, properties) {}

    /// Runs until the true shaft's time `until_s`; the encoder is silent from `dark_from_s` to `dark_to_s`.
    void run(double until_s, double dark_from_s = 1e9, double dark_to_s = 1e9) {
        while (instant_s < until_s) {
            const double period_noise = random.unit() - 0.5;
            instant_s += sampling.period_s + period_noise * sampling.period_jitter_s;
            const double delay = random.unit() * sampling.stamp_delay_s;
            const bool missing = random.one_in(sampling.missing_one_in);
            if (missing || (instant_s > dark_from_s && instant_s < dark_to_s)) continue;
            const Time stamp = at_s(instant_s + delay);
            timers_until(stamp);
            estimator.sample(code_at(shaft.degrees(instant_s), sampling.codes_per_turn), stamp);
            schedule.update(estimator, stamp);
        }
        timers_until(at_s(until_s));
    }

    void run_to_the_end() { run(shaft.end_s()); }
    void timers_until(Time until) {
        for (Time due = schedule.next_due(); due <= until; due = schedule.next_due()) {
            now = std::max(now, due);
            schedule.advance(now, [this](const CamEvent& event) noexcept TAPPET_REALTIME {
                TAPPET_ESCAPE("the test's record", fired.push_back({event, now}));
            });
        }
        now = std::max(now, until);
    }

    [[nodiscard]] std::size_t count(std::size_t row, CamKind kind) const {
        return static_cast<std::size_t>(std::count_if(fired.begin(), fired.end(), [&](const Fired& f) {
            return f.event.row == row && f.event.kind == kind;
        }));
    }

    TrueShaft shaft;
    Sampling sampling;
    Random random;
    ShaftEstimator estimator;
    CamSchedule<N> schedule;
    std::vector<Fired> fired;
    double instant_s = 0.0;
    Time now{};
};

} // namespace tappet::test

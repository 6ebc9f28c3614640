// Estimates a shaft between encoder samples: a Kalman filter over position, velocity and acceleration.
// (Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking and Navigation, 6.2.3: white noise
// jerk.)
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/text.hpp"
#include "kernel/base/time.hpp"
#include "kernel/cam/angle.hpp"
#include "kernel/cam/motion.hpp"

#include <array>
#include <cstdint>

namespace tappet {

/// The encoder, its shaft, and the weights of the estimator.
struct ShaftProperties {
    std::uint32_t codes_per_turn = 4096;
    Angle zero{};                           // the machine's angle at the encoder's edge of code 0
    Duration stamp_latency = 0us;           // mean delay of the stamp after the instant of the code
    Duration stamp_jitter = 0us;            // standard deviation of that delay (uniform over w: w / sqrt(12))
    Speed max_speed = 2200_rpm;             // a jump faster than this is a fault of the encoder
    double max_acceleration_deg_s2 = 2.0e5; // the hardest braking of the shaft
    double jerk_density = 2.0e8;            // process noise at constant speed, deg^2/s^5
    double manoeuvre_gain = 3000.0;         // factor on it while the samples leave the prediction
    Duration standstill_after = 20ms;       // without a new code for so long, the speed is exactly 0
    Duration max_age = 4ms;                 // older than this, the estimate is stale
    Duration lost_after = 20ms;           // after a longer gap while turning, the count of turns is uncertain
    Duration acceleration_horizon = 20ms; // assumed duration of an acceleration
};

/// Returns the fault in the properties and its cure; empty when there is none.
constexpr Sentence check(const ShaftProperties& p) {
    if (p.codes_per_turn < 8 || p.codes_per_turn > (1u << 24))
        return Sentence{"shaft: codes_per_turn is ", p.codes_per_turn, "; give a number from 8 to 16777216"};
    if (!(p.max_speed > Speed{})) return Sentence{"shaft: max_speed is not above 0; give the fastest speed"};
    if (!(p.max_acceleration_deg_s2 > 0.0))
        return Sentence{"shaft: max_acceleration_deg_s2 is not above 0; give the hardest braking"};
    if (!(p.jerk_density > 0.0) || !(p.manoeuvre_gain >= 1.0))
        return Sentence{
            "shaft: the process noise is too small; give jerk_density > 0 and manoeuvre_gain >= 1"};
    if (p.stamp_jitter < 0us || p.stamp_latency < 0us)
        return Sentence{"shaft: stamp_jitter or stamp_latency is negative; give how late the stamps are"};
    if (p.standstill_after <= 0us || p.max_age <= 0us || p.lost_after < p.max_age)
        return Sentence{
            "shaft: standstill_after, max_age and lost_after must be above 0, and lost_after at least "
            "max_age; lengthen the one that is too short"};
    // In a gap, an unseen acceleration moves the shaft by a t^2 / 2; beyond half a turn the turn is a guess.
    if (const double gap = to_seconds(p.lost_after); 0.5 * p.max_acceleration_deg_s2 * gap * gap > 180.0)
        return Sentence{"shaft: in a gap of lost_after the shaft may turn half a turn unseen at "
                        "max_acceleration_deg_s2; shorten lost_after"};
    return {};
}

/// Counters of the samples since the beginning.
struct ShaftCounters {
    std::uint64_t accepted = 0;
    std::uint64_t out_of_order = 0; // stamp not later than the last one: rejected (duplicates too)
    std::uint64_t bad_code = 0;     // code beyond codes_per_turn: rejected
    std::uint64_t implausible = 0;  // faster than max_speed: rejected, fault raised
    std::uint64_t outliers = 0;     // beyond max_acceleration: rejected once, accepted when it persists
    std::uint64_t gaps = 0;         // longer than lost_after: restarted
    std::uint64_t resets = 0;       // restarts after gaps and implausible jumps; each raises `epoch`
    constexpr bool operator==(const ShaftCounters&) const = default;
};

/// The estimator. One writer; readers in the same activity. The position is an exact integer; the filter
/// works on the small remainder, so that no precision is lost after any number of turns.
class ShaftEstimator {
public:
    /// Contract: check(properties) is empty.
    explicit ShaftEstimator(const ShaftProperties& properties) noexcept TAPPET_REALTIME;

    /// Takes one reading of the encoder: `code` in [0, codes_per_turn) at `stamp`. Real-time, no loop.
    void sample(std::uint32_t code, Time stamp) noexcept TAPPET_REALTIME;

    /// Returns the past or predicted position at `t`. Real-time.
    [[nodiscard]] ShaftState at(Time t) const noexcept TAPPET_REALTIME { return motion_.at(t); }
    /// See ShaftMotion::when. Real-time.
    [[nodiscard]] Time when(ShaftPosition target, Time not_before) const noexcept TAPPET_REALTIME {
        return motion_.when(target, not_before);
    }
    [[nodiscard]] const ShaftMotion& motion() const noexcept TAPPET_REALTIME { return motion_; }

    /// Returns whether enough samples were accepted and the last one is at most max_age old. Real-time.
    [[nodiscard]] bool valid(Time now) const noexcept TAPPET_REALTIME { return now <= valid_until(); }
    /// Returns the last instant of valid() if no more samples come. Real-time.
    [[nodiscard]] Time valid_until() const noexcept TAPPET_REALTIME {
        if (settled_ < settle_samples) return Time::min();
        return motion_.stamp + properties_.max_age + properties_.stamp_latency;
    }
    /// Returns whether the shaft stands: the velocity is exactly 0 and the position does not creep.
    [[nodiscard]] bool standing() const noexcept TAPPET_REALTIME { return standing_; }
    /// Returns whether an implausible jump was seen; stays until acknowledged.
    [[nodiscard]] bool fault() const noexcept TAPPET_REALTIME { return fault_; }
    void acknowledge() noexcept TAPPET_REALTIME { fault_ = false; }
    /// Increases whenever the position may have jumped: after a gap, or after `agreeing_jumps` implausible
    /// samples in a row that agree with one another (the encoder is trusted then).
    [[nodiscard]] std::uint32_t epoch() const noexcept TAPPET_REALTIME { return epoch_; }
    [[nodiscard]] const ShaftCounters& counters() const noexcept TAPPET_REALTIME { return counters_; }
    /// Returns the filter's standard deviation of the position at the last sample, degrees.
    [[nodiscard]] double deviation_deg() const noexcept TAPPET_REALTIME;

    static constexpr std::uint32_t settle_samples = 4;
    static constexpr std::uint32_t agreeing_jumps = 3;

private:
    struct Reading {
        std::uint32_t code = 0;
        Angle centre;
        Time stamp{};
    };
    void start(const Reading& now) noexcept TAPPET_REALTIME;
    void reset(const Reading& now) noexcept TAPPET_REALTIME;
    void suspect(const Reading& now) noexcept TAPPET_REALTIME;
    void filter(const Reading& now) noexcept TAPPET_REALTIME;
    void open(double velocity_deviation) noexcept TAPPET_REALTIME;
    void settle(const Reading& now) noexcept TAPPET_REALTIME;
    void stand(const Reading& now) noexcept TAPPET_REALTIME;
    void fold(double moved_deg) noexcept TAPPET_REALTIME;
    [[nodiscard]] bool at_rest_codes(std::uint32_t code) const noexcept TAPPET_REALTIME {
        return code == rest_codes_[0] || code == rest_codes_[1];
    }
    [[nodiscard]] bool reachable(const Reading& from, const Reading& to) const noexcept TAPPET_REALTIME;

    ShaftProperties properties_;
    double step_deg_ = 0.0;      // one code
    double step_variance_ = 0.0; // of its rounding
    double jitter_s_ = 0.0;
    ShaftMotion motion_;    // the estimate, at the last sample
    double rest_deg_ = 0.0; // the part of the position finer than 2^-32 turn
    std::array<double, 9> covariance_{};
    Reading last_;      // the last accepted sample
    Reading suspected_; // the last implausible one
    std::uint32_t suspected_in_a_row_ = 0;
    std::uint32_t outliers_in_a_row_ = 0;
    std::uint32_t settled_ = 0;
    std::array<std::uint32_t, 2>
        rest_codes_{}; // a shaft at the edge of two codes may show either and still stand
    Time rest_since_{};
    std::uint32_t epoch_ = 0;
    bool standing_ = false;
    bool fault_ = false;
    ShaftCounters counters_;
};

} // namespace tappet

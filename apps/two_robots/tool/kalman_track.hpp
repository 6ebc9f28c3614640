// One value and its speed from noisy measurements, by a Kalman filter of constant speed.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/motion/estimators.hpp"

namespace two_robots {

using namespace tappet;

/// Has the interface of motion::AlphaBeta. Real-time.
class KalmanTrack {
public:
    /// Standard deviations: of the acceleration, which changes from sample to sample, and of a sample.
    struct Noise {
        double acceleration, noise;
    };
    explicit constexpr KalmanTrack(Noise of) noexcept TAPPET_REALTIME : of_{of} {}

    /// Adds a value that was true at `at`; ignores one that is not later than the last one.
    void sample(double value, Time at) noexcept TAPPET_REALTIME {
        if (samples_ > 0 && at <= at_) return;
        const double h = to_seconds(at - at_);
        const double r = of_.noise * of_.noise;
        if (samples_ == 0) {
            place_ = value;
        } else if (samples_ == 1) { // two values tell no more
            speed_ = (value - place_) / h;
            place_ = value;
            variances_ = {r, r / h, 2.0 * r / (h * h)};
        } else {
            update(value, h, r);
        }
        at_ = at;
        if (samples_ < 2) ++samples_;
    }
    [[nodiscard]] bool good() const noexcept TAPPET_REALTIME { return samples_ == 2; }
    [[nodiscard]] double at(Time when) const noexcept TAPPET_REALTIME {
        return place_ + speed_ * to_seconds(when - at_);
    }
    [[nodiscard]] double velocity() const noexcept TAPPET_REALTIME { return speed_; }

private:
    using Filter = motion::Kalman<2>;

    void update(double value, double h, double r) noexcept TAPPET_REALTIME {
        Filter filter{{place_, speed_}, symmetric(variances_)};
        const double q = of_.acceleration * of_.acceleration * h * h;
        Filter::Covariance moves;
        moves << 1.0, h, 0.0, 1.0;
        filter.predict(moves, symmetric({0.25 * q * h * h, 0.5 * q * h, q}));
        const Eigen::Matrix<double, 1, 1> measured{value}, spread{r};
        if (!filter.update<1>(measured, {1.0, 0.0}, spread)) return; // not a number: ignored
        place_ = filter.state()[0];
        speed_ = filter.state()[1];
        const Filter::Covariance& now = filter.covariance();
        variances_ = {now(0, 0), now(0, 1), now(1, 1)};
    }
    struct Variances {
        double place = 0.0, both = 0.0, speed = 0.0;
    };
    static Filter::Covariance symmetric(const Variances& of) noexcept TAPPET_REALTIME {
        Filter::Covariance matrix;
        matrix << of.place, of.both, of.both, of.speed;
        return matrix;
    }

    Noise of_;
    double place_ = 0.0, speed_ = 0.0;
    Variances variances_{};
    Time at_{};
    int samples_ = 0;
};

} // namespace two_robots

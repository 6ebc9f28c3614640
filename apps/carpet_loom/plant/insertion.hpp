// The weft: the release valve with its dead time, the flight through the shed, the arrival, and the possible
// faults.
#pragma once

#include "apps/carpet_loom/plant/shapes.hpp"
#include "apps/carpet_loom/wires.hpp"
#include "kernel/base/random.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>

namespace tappet::loom {

/// Result for a weft at the moment its valve opened.
enum class Release : std::uint8_t { nothing, flies, closed_shed, second_weft };

class Insertion {
public:
    explicit Insertion(Random& random) noexcept TAPPET_REALTIME {
        const double dead = 0.9 + 0.2 * random.unit();
        dead_ = Duration{round_to_int(dead * static_cast<double>(wires::nominal::weft_release_dead.count()))};
        yarn_deg_ = -3.0 + 6.0 * random.unit();
    }

    void set_valve(bool on, Time now) noexcept TAPPET_REALTIME {
        if (on == line_) return;
        line_ = on;
        if (on) {
            measure_at_ = now + wires::nominal::weft_release_dead;
            open_at_ = now + dead_;
        } else { // a pulse shorter than the dead time has no effect
            if (now < open_at_) measure_at_ = never;
            open_at_ = never;
        }
    }
    [[nodiscard]] bool line() const noexcept TAPPET_REALTIME { return line_; }

    /// When the effect is due by the dead time that the machine knows; the plant then measures the angle.
    [[nodiscard]] Time measure_at() const noexcept TAPPET_REALTIME { return measure_at_; }
    void measured() noexcept TAPPET_REALTIME { measure_at_ = never; }
    [[nodiscard]] Time open_at() const noexcept TAPPET_REALTIME { return open_at_; }
    [[nodiscard]] Time arrive_at() const noexcept TAPPET_REALTIME { return arrive_at_; }
    [[nodiscard]] Time next() const noexcept TAPPET_REALTIME {
        return std::min({measure_at_, open_at_, arrive_at_});
    }

    /// Opens the valve at a true position. `breaks`: this weft never arrives.
    Release open(double position_deg, bool fed, bool breaks, Random& random) noexcept TAPPET_REALTIME {
        open_at_ = never;
        const double angle = angle_of_position(position_deg);
        if (angle < wires::nominal::shed_open_deg || angle > wires::nominal::shed_closed_deg)
            return Release::closed_shed;
        if (wefts_ > 0) return Release::second_weft;
        ++wefts_;
        const double yarn = yarn_deg_ + 3.0 * (random.unit() - 0.5);
        if (fed && !breaks) gate_deg_ = position_deg + flight_deg + yarn;
        return Release::flies;
    }
    /// Follows the shaft over a step that began at `begin` and took dt: past the gate, only the yarn's lag is
    /// left.
    void follow(double before_deg, double after_deg, Time begin, double dt_s) noexcept TAPPET_REALTIME {
        if (after_deg < gate_deg_) return;
        const double part =
            after_deg > before_deg ? (gate_deg_ - before_deg) / (after_deg - before_deg) : 1.0;
        arrive_at_ = begin + Duration{round_to_int(part * dt_s * 1e9)} + lag;
        gate_deg_ = no_gate_deg;
    }
    void arrive() noexcept TAPPET_REALTIME {
        arrive_at_ = never;
        arrived_ = true;
    }
    /// The operator inserts the missing weft by hand.
    void lay_by_hand() noexcept TAPPET_REALTIME { by_hand_ = true; }

    [[nodiscard]] bool released() const noexcept TAPPET_REALTIME { return wefts_ > 0; }
    [[nodiscard]] bool arrived() const noexcept TAPPET_REALTIME { return arrived_; }
    [[nodiscard]] bool by_hand() const noexcept TAPPET_REALTIME { return by_hand_; }
    [[nodiscard]] bool under_way() const noexcept TAPPET_REALTIME {
        return gate_deg_ != no_gate_deg || arrive_at_ != never;
    }

    /// Empties the shed after beat-up.
    void next_shed() noexcept TAPPET_REALTIME {
        wefts_ = 0;
        arrived_ = false;
        by_hand_ = false;
        gate_deg_ = no_gate_deg;
        arrive_at_ = never;
    }

private:
    static constexpr double no_gate_deg = 1e18;
    // The gripper's part is geared to the shaft, the yarn's part takes time: together the nominal arrival.
    static constexpr Duration lag = 4ms;
    static constexpr double lag_deg = 6.0 * wires::nominal::speed_rpm * to_seconds(lag);
    static constexpr double flight_deg =
        wires::nominal::weft_arrival_deg - wires::nominal::weft_release_deg - lag_deg;
    static_assert(flight_deg > 0.0, "the yarn's lag is only a part of the flight");

    bool line_ = false;
    Duration dead_{};
    double yarn_deg_ = 0.0;
    Time measure_at_ = never;
    Time open_at_ = never;
    Time arrive_at_ = never;
    double gate_deg_ = no_gate_deg;
    int wefts_ = 0;
    bool arrived_ = false;
    bool by_hand_ = false;
};

} // namespace tappet::loom

// Motion profile of one axis: at most seven pieces of constant jerk, each evaluated in closed form.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/contract.hpp"
#include "kernel/base/number.hpp"
#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tappet::motion {

/// State of one axis, in its unit (rad, m or any other) and seconds.
struct AxisState {
    double position = 0.0;
    double velocity = 0.0;
    double acceleration = 0.0;
};

/// Limits of an axis, in its unit and seconds; all positive.
struct AxisLimits {
    double velocity = 0.0;
    double acceleration = 0.0; ///< and deceleration
    double jerk = 0.0;         ///< ignored by profiles without bounded jerk
};

class Profile {
public:
    static constexpr std::size_t most_pieces = 7;

    Profile() noexcept TAPPET_REALTIME = default;
    /// Starts an empty profile at rest; pieces follow.
    explicit Profile(const AxisState& from) noexcept TAPPET_REALTIME : end_(from),
                                                                       farthest_(std::fabs(from.position)),
                                                                       fastest_(std::fabs(from.velocity)) {}

    /// Appends a piece that begins with `acceleration`. A piece of no duration is left out.
    void add(double seconds, double acceleration, double jerk) noexcept TAPPET_REALTIME {
        if (!(seconds > 0.0)) return;
        end_.acceleration = acceleration;
        TAPPET_CONTRACT(pieces_.push({end_, jerk, duration_s_}), Contract::index_out_of_range, pieces_.size(),
                        most_pieces);
        const Piece one_way{{farthest_, std::fabs(end_.velocity), std::fabs(acceleration)}, std::fabs(jerk)};
        farthest_ = one_way.at(seconds).position;
        fastest_ = std::max(fastest_, one_way.at(seconds).velocity);
        end_ = pieces_[pieces_.size() - 1].at(seconds);
        duration_s_ += seconds;
    }
    /// Ends at rest, exactly at `position`. Returns false when the pieces do not lead there, or overflow.
    [[nodiscard]] bool rest_at(double position) noexcept TAPPET_REALTIME {
        constexpr double rounding = 1e-6, nothing = 1e-150; // smaller numbers underflow when squared
        const bool leads_there = is_number(duration_s_ + farthest_ + fastest_) &&
                                 std::fabs(end_.position - position) <= rounding * farthest_ + nothing &&
                                 std::fabs(end_.velocity) <= rounding * fastest_ + nothing;
        end_ = {position, 0.0, 0.0};
        return leads_there;
    }

    [[nodiscard]] std::size_t pieces() const noexcept TAPPET_REALTIME { return pieces_.size(); }
    [[nodiscard]] double duration_s() const noexcept TAPPET_REALTIME { return duration_s_; }
    /// Returns the last state. It holds from the end of the profile on.
    [[nodiscard]] const AxisState& end() const noexcept TAPPET_REALTIME { return end_; }

    /// Returns the state `seconds` after the start; before it, the first state. At most most_pieces steps.
    [[nodiscard]] AxisState at_s(double seconds) const noexcept TAPPET_REALTIME {
        if (pieces_.empty() || !(seconds < duration_s_)) return end_;
        std::size_t i = pieces_.size() - 1;
        while (i > 0 && seconds < pieces_[i].from_s) --i;
        const double inside = seconds - pieces_[i].from_s;
        return pieces_[i].at(inside > 0.0 ? inside : 0.0);
    }
    [[nodiscard]] AxisState at(Duration since_begin) const noexcept TAPPET_REALTIME {
        return at_s(to_seconds(since_begin));
    }

private:
    struct Piece {
        AxisState from;
        double jerk = 0.0;
        double from_s = 0.0;
        [[nodiscard]] AxisState at(double t) const noexcept TAPPET_REALTIME {
            const double a = from.acceleration;
            return {from.position + t * (from.velocity + t * (0.5 * a + t * jerk / 6.0)),
                    from.velocity + t * (a + 0.5 * t * jerk), a + t * jerk};
        }
    };
    Bounded<Piece, most_pieces> pieces_;
    AxisState end_;
    double duration_s_ = 0.0;
    double farthest_ = 0.0; ///< upper bound of |position|: its value if all motion went away from zero
    double fastest_ = 0.0;
};

} // namespace tappet::motion

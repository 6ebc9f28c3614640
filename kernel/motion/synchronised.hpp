// Several axes that start and arrive together: the slowest one sets the time, the others move slower.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/motion/chain.hpp"
#include "kernel/motion/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <expected>

namespace tappet::motion {

template <int axes>
struct AxesState {
    Joints<axes> position;
    Joints<axes> velocity;
    Joints<axes> acceleration;
};

/// Each axis has its own jerk-limited profile, stretched in time to the longest duration: velocities shrink
/// by the ratio of durations, accelerations by its square, jerks by its cube, so that every limit still
/// holds.
template <int axes>
class Synchronised {
public:
    using Limits = std::array<AxisLimits, static_cast<std::size_t>(axes)>;

    /// Plans from rest to rest. Refused: which axis, and why. Real-time.
    static std::expected<Synchronised, Refused> plan(const Joints<axes>& from, const Joints<axes>& target,
                                                     const Limits& limits) noexcept TAPPET_REALTIME {
        Synchronised all;
        for (int i = 0; i < axes; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const Planned one = jerk_limited(from[i], target[i], limits[at]);
            if (!one) return std::unexpected(Refused{one.error().why, i});
            all.profiles_[at] = *one;
            all.duration_s_ = std::max(all.duration_s_, one->duration_s());
        }
        return all;
    }
    [[nodiscard]] double duration_s() const noexcept TAPPET_REALTIME { return duration_s_; }
    /// Returns the state at `seconds`. At most 7 steps for each axis.
    [[nodiscard]] AxesState<axes> at_s(double seconds) const noexcept TAPPET_REALTIME {
        AxesState<axes> state;
        for (int i = 0; i < axes; ++i) {
            const Profile& profile = profiles_[static_cast<std::size_t>(i)];
            const double pace = duration_s_ > 0.0 ? profile.duration_s() / duration_s_ : 1.0;
            const AxisState one = seconds < duration_s_ ? profile.at_s(pace * seconds) : profile.end();
            state.position[i] = one.position;
            state.velocity[i] = pace * one.velocity;
            state.acceleration[i] = pace * pace * one.acceleration;
        }
        return state;
    }
    [[nodiscard]] AxesState<axes> at(Duration since_begin) const noexcept TAPPET_REALTIME {
        return at_s(to_seconds(since_begin));
    }

private:
    std::array<Profile, static_cast<std::size_t>(axes)> profiles_;
    double duration_s_ = 0.0;
};

} // namespace tappet::motion

// Sines, trajectories, controllers and estimators: the calculations of one axis in a cycle.
#include "tests/figures/motion/groups.hpp"

#include "kernel/base/random.hpp"
#include "kernel/motion/estimators.hpp"
#include "kernel/motion/filters.hpp"
#include "kernel/motion/pid.hpp"
#include "kernel/motion/sine.hpp"
#include "kernel/motion/synchronised.hpp"

#include <kdl/velocityprofile_trap.hpp>

#include <array>
#include <cmath>

#include <dlfcn.h>

namespace tappet::figures {

namespace {

using namespace motion;

std::array<double, many> angles = [] {
    Random random{2};
    std::array<double, many> all{};
    for (double& angle : all) angle = 6.0 * random.unit() - 3.0;
    return all;
}();

template <class Both>
void six(std::size_t times, Both both) {
    in_turn(times, [&](std::size_t k) {
        std::array<SineCosine, 6> result;
        for (std::size_t axis = 0; axis < 6; ++axis) result[axis] = both(angles[(k + axis) % many]);
        return result;
    });
}
void own_sine(std::size_t times) {
    in_turn(times, [](std::size_t k) {
        std::array<SineCosine, 6> result;
        for (std::size_t axis = 0; axis < 6; axis += 2)
            sine_cosine_of_two(angles[(k + axis) % many], angles[(k + axis + 1) % many], result[axis],
                               result[axis + 1]);
        return result;
    });
}
void own_sine_alone(std::size_t times) { six(times, sine_cosine); }
void musl_sine(std::size_t times) {
    six(times, [](double angle) { return SineCosine{std::sin(angle), std::cos(angle)}; });
}
/// The host's glibc function: this program itself is linked with musl, as a firmware is.
double (*of_glibc(const char* name))(double) {
    static void* const library = dlopen("libm.so.6", RTLD_NOW);
    return reinterpret_cast<double (*)(double)>(dlsym(library, name));
}
void glibc_sine(std::size_t times) {
    static auto* const sine = of_glibc("sin");
    static auto* const cosine = of_glibc("cos");
    six(times, [](double angle) { return SineCosine{sine(angle), cosine(angle)}; });
}

constexpr AxisLimits limits{1.0, 4.0, 40.0};
void plan_trapezoid(std::size_t times) {
    in_turn(times,
            [](std::size_t k) { return trapezoid({angles[k], 0.3, 0.0}, angles[(k + 1) % many], limits); });
}
void plan_jerk_limited(std::size_t times) {
    in_turn(times, [](std::size_t k) { return jerk_limited(angles[k], angles[(k + 1) % many], limits); });
}
void plan_stop(std::size_t times) {
    in_turn(times, [](std::size_t k) { return stop({0.0, angles[k], angles[(k + 1) % many]}, limits); });
}
void plan_kdl(std::size_t times) {
    static KDL::VelocityProfile_Trap peer{limits.velocity, limits.acceleration};
    in_turn(times, [](std::size_t k) { peer.SetProfile(angles[k], angles[(k + 1) % many]); });
}
const Profile& some_profile() {
    static const Profile profile = *jerk_limited(-2.0, 2.0, limits);
    return profile;
}
void look_at_profile(std::size_t times) {
    in_turn(times, [&profile = some_profile()](std::size_t k) {
        return profile.at_s((angles[k] + 3.0) / 6.0 * profile.duration_s());
    });
}
void look_at_kdl(std::size_t times) {
    static KDL::VelocityProfile_Trap peer{limits.velocity, limits.acceleration};
    peer.SetProfile(-2.0, 2.0);
    in_turn(times, [](std::size_t k) {
        const double t = (angles[k] + 3.0) / 6.0 * peer.Duration();
        return AxisState{peer.Pos(t), peer.Vel(t), peer.Acc(t)};
    });
}
void plan_six(std::size_t times) {
    static constexpr Synchronised<6>::Limits all{limits, limits, limits, limits, limits, limits};
    in_turn(times, [](std::size_t k) {
        Joints<6> from;
        Joints<6> target;
        for (int axis = 0; axis < 6; ++axis) {
            const auto at = k + static_cast<std::size_t>(axis);
            from[axis] = angles[at % many];
            target[axis] = angles[(at + 1) % many];
        }
        return Synchronised<6>::plan(from, target, all);
    });
}

void step_pid(std::size_t times) {
    static Pid pid{{.proportional = 2.0,
                    .integral = 1.0,
                    .derivative = 0.1,
                    .derivative_filter_s = 0.01,
                    .tracking_s = 0.5,
                    .lowest = -10.0,
                    .highest = 10.0}};
    in_turn(times, [](std::size_t k) { return pid(0.5, angles[k], 2ms, 0.1); });
}
void step_biquad(std::size_t times) {
    static Biquad filter = *Biquad::low_pass(40.0, 2ms);
    in_turn(times, [](std::size_t k) { return filter(angles[k]); });
}
void step_kalman(std::size_t times) {
    static Kalman<3> filter{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
    static const Eigen::Matrix3d move{{1.0, 2e-3, 2e-6}, {0.0, 1.0, 2e-3}, {0.0, 0.0, 1.0}};
    static const Eigen::Matrix3d noise = 1e-3 * Eigen::Matrix3d::Identity();
    in_turn(times, [](std::size_t k) {
        filter.predict(move, noise);
        return filter.update<1>(Eigen::Matrix<double, 1, 1>{angles[k]}, {1.0, 0.0, 0.0},
                                Eigen::Matrix<double, 1, 1>{0.1});
    });
}

} // namespace

void add_loops(std::vector<Group>& groups) {
    groups.push_back(
        {"motion.sine",
         "sine and cosine of six angles",
         "",
         64,
         {{"of kernel/motion, two at a time: they count in all other figures", Standing::ours, &own_sine},
          {"of kernel/motion, one at a time", Standing::ours, &own_sine_alone},
          {"musl's, which a firmware links", Standing::peer, &musl_sine},
          {"glibc's on this processor", Standing::peer, &glibc_sine}}});
    groups.push_back({"motion.trajectory",
                      "a trajectory of one axis; six axes at once",
                      "",
                      64,
                      {{"plan a trapezoid from any state", Standing::ours, &plan_trapezoid},
                       {"plan a jerk-limited way from rest to rest", Standing::ours, &plan_jerk_limited},
                       {"plan a jerk-limited stop from any state", Standing::ours, &plan_stop},
                       {"state at a time", Standing::ours, &look_at_profile},
                       {"plan six axes that arrive together", Standing::ours, &plan_six},
                       {"KDL, plan a trapezoid from rest to rest", Standing::peer, &plan_kdl},
                       {"KDL, state at a time", Standing::peer, &look_at_kdl}}});
    groups.push_back({"motion.control",
                      "one step of a loop",
                      "",
                      64,
                      {{"PID with all its options", Standing::ours, &step_pid},
                       {"low pass of second order", Standing::ours, &step_biquad},
                       {"Kalman filter, three states, one measurement", Standing::ours, &step_kalman}}});
}

} // namespace tappet::figures

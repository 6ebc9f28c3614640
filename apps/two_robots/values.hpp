// The values between the components of a robot: six joints, the postures of its arm, commanded frames.
#pragma once

#include "kernel/motion/kinematics.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>

namespace two_robots {

using namespace tappet;

/// The reference frames of each robot: its mounting base, and the end of its arm.
struct Base;
struct Flange;

/// rad, rad/s or V, one for each joint.
using Joints = motion::Joints<6>;
/// Limits each joint to -most..most; largest() returns the largest absolute value. Real-time; the compiler
/// does not know Eigen's own functions as such.
inline Joints within(const Joints& joints, double most) noexcept TAPPET_REALTIME {
    Joints bounded;
    for (int i = 0; i < 6; ++i) bounded[i] = std::min(std::max(joints[i], -most), most);
    return bounded;
}
inline double largest(const Joints& joints) noexcept TAPPET_REALTIME {
    double most = 0.0;
    for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(joints[i]));
    return most;
}

using FlangeFrame = motion::Frame<Base, Flange>;
using FlangeTwist = motion::Twist<Flange, Base, Flange, Base>;
using FlangeJacobian = motion::Jacobian<Flange, Base, Flange, Base, 6>;

/// Numbers in the form in which methods pass them: trivially copyable; matrices column by column.
struct SixNumbers {
    std::array<double, 6> of{};

    SixNumbers() = default;
    explicit SixNumbers(const Joints& joints) noexcept TAPPET_REALTIME {
        for (int i = 0; i < 6; ++i) of[static_cast<std::size_t>(i)] = joints[i];
    }
    [[nodiscard]] Joints joints() const noexcept TAPPET_REALTIME {
        Joints joints;
        for (int i = 0; i < 6; ++i) joints[i] = of[static_cast<std::size_t>(i)];
        return joints;
    }
};

struct FrameNumbers {
    std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::array<double, 3> position{};

    FrameNumbers() = default;
    explicit FrameNumbers(const FlangeFrame& frame) noexcept TAPPET_REALTIME {
        Eigen::Map<Eigen::Matrix3d>{rotation.data()} = frame.rotation;
        Eigen::Map<Eigen::Vector3d>{position.data()} = frame.position;
    }
    [[nodiscard]] FlangeFrame frame() const noexcept TAPPET_REALTIME {
        FlangeFrame frame;
        frame.rotation = Eigen::Map<const Eigen::Matrix3d>{rotation.data()};
        frame.position = Eigen::Map<const Eigen::Vector3d>{position.data()};
        return frame;
    }
};

/// The flange's posture for some joints, and its motion with them.
struct Posture {
    FrameNumbers flange{};
    std::array<double, 36> jacobian_numbers{};

    [[nodiscard]] FlangeFrame frame() const noexcept TAPPET_REALTIME { return flange.frame(); }
    [[nodiscard]] FlangeJacobian jacobian() const noexcept TAPPET_REALTIME {
        FlangeJacobian jacobian;
        jacobian.matrix = Eigen::Map<const Eigen::Matrix<double, 6, 6>>{jacobian_numbers.data()};
        return jacobian;
    }
};

/// The command of a level above to the flange: its frame and its speed there.
struct FlangeCommand {
    FlangeFrame frame{};
    FlangeTwist twist{};
};

} // namespace two_robots

namespace tappet {

template <>
inline constexpr bool copied_as_bytes<two_robots::FlangeCommand> = true;
template <>
inline constexpr auto fields_of<two_robots::FlangeCommand> = fields(
    field<&two_robots::FlangeCommand::frame>("frame"), field<&two_robots::FlangeCommand::twist>("twist"));

} // namespace tappet

// The values of the tool's loop: the body's place, and the tip's set point in the body's frame.
#pragma once

#include "apps/two_robots/values.hpp"

namespace two_robots {

/// The body that is operated on. Its origin is the middle of the hole; its z axis points out of the chest.
struct Body;
/// The end of the tool's shaft; its z axis extends the shaft.
struct Tip;

using BodyFrame = motion::Frame<Base, Body>;
using BodyTip = motion::Frame<Body, Tip>;
using FlangeTip = motion::Frame<Flange, Tip>;

struct BodyModel {
    BodyFrame frame{};
    motion::Twist<Body, Base, Body, Base> twist{};
};

struct TipSetPoint {
    double tool_length = 0.0; ///< from flange to tip, m
    BodyTip frame{};
    motion::Twist<Tip, Body, Tip, Body> twist{};
};

} // namespace two_robots

namespace tappet {

template <>
inline constexpr bool copied_as_bytes<two_robots::BodyModel> = true;
template <>
inline constexpr auto fields_of<two_robots::BodyModel> =
    fields(field<&two_robots::BodyModel::frame>("frame"), field<&two_robots::BodyModel::twist>("twist"));
template <>
inline constexpr bool copied_as_bytes<two_robots::TipSetPoint> = true;
template <>
inline constexpr auto fields_of<two_robots::TipSetPoint> =
    fields(field<&two_robots::TipSetPoint::tool_length>("tool_length", "m"),
           field<&two_robots::TipSetPoint::frame>("frame"), field<&two_robots::TipSetPoint::twist>("twist"));

} // namespace tappet

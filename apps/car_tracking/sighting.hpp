// The result of searching for the car in one image.
#pragma once

#include "apps/car_tracking/geometry.hpp"

namespace tappet::car_tracking {

struct Sighting {
    bool located = false;
    double x = 0.0; ///< in the room; from the last image in which it was located
    double y = 0.0;
    Aim offset{};       ///< from the camera's aim to the car
    bool whole = false; ///< the whole car is inside the image
    std::int64_t pixels = 0;
};

} // namespace tappet::car_tracking

template <>
inline constexpr auto tappet::fields_of<tappet::car_tracking::Sighting> =
    tappet::fields(tappet::field<&tappet::car_tracking::Sighting::located>("located"),
                   tappet::field<&tappet::car_tracking::Sighting::x>("x", "m"),
                   tappet::field<&tappet::car_tracking::Sighting::y>("y", "m"),
                   tappet::field<&tappet::car_tracking::Sighting::offset>("offset"),
                   tappet::field<&tappet::car_tracking::Sighting::whole>("whole"),
                   tappet::field<&tappet::car_tracking::Sighting::pixels>("pixels"));

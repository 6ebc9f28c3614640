// Two robots of the literature as tables: the PUMA 560 with standard parameters, masses and drives (Corke and
// Armstrong-Helouvry 1994), and KUKA's K361 with the wrist equivalent to its two mirrored cones.
#pragma once

#include "kernel/motion/chain.hpp"

namespace tappet::motion::robots {

struct World;
struct Flange;

// clang-format off
inline constexpr Chain<World, Flange, 6> puma_560_links{{{
    {.alpha_deg = 90, .inertia = {.yy = 0.35}},
    {.a_m = 0.4318, .mass_kg = 17.4, .centre_m = {-0.3638, 0.006, 0.2275}, .inertia = {0.13, 0.524, 0.539}},
    {.a_m = 0.0203, .alpha_deg = -90, .d_m = 0.15005, .mass_kg = 4.8, .centre_m = {-0.0203, -0.0141, 0.070}, .inertia = {0.066, 0.086, 0.0125}},
    {.alpha_deg = 90, .d_m = 0.4318, .mass_kg = 0.82, .centre_m = {0, 0.019, 0}, .inertia = {1.8e-3, 1.3e-3, 1.8e-3}},
    {.alpha_deg = -90, .mass_kg = 0.34, .inertia = {0.3e-3, 0.4e-3, 0.3e-3}},
    {.mass_kg = 0.09, .centre_m = {0, 0, 0.032}, .inertia = {0.15e-3, 0.15e-3, 0.04e-3}},
}}};

inline constexpr auto puma_560 = [] {
    auto puma = puma_560_links;
    puma.links[0].drive = {-62.6111, 200e-6, 1.48e-3, 0.395, 0.435};
    puma.links[1].drive = {107.815, 200e-6, 0.817e-3, 0.126, 0.071};
    puma.links[2].drive = {-53.7063, 200e-6, 1.38e-3, 0.132, 0.105};
    puma.links[3].drive = {76.0364, 33e-6, 71.2e-6, 11.2e-3, 16.9e-3};
    puma.links[4].drive = {71.923, 33e-6, 82.6e-6, 9.26e-3, 14.5e-3};
    puma.links[5].drive = {76.686, 33e-6, 36.7e-6, 3.96e-3, 10.5e-3};
    return puma;
}();

/// Rz(q1) Tz(1.020) Rx(-q2) Tz(0.480) Rx(-q3) Tz(0.645) Rz(q4) Rx(-q5) Rz(q6) Tz(0.120).
inline constexpr Chain<World, Flange, 6> k361{{{
    {.alpha_deg = 90, .d_m = 1.020, .theta_deg = 90},
    {.a_m = 0.480, .theta_deg = 90, .reversed = true},
    {.alpha_deg = -90, .theta_deg = -90, .reversed = true},
    {.alpha_deg = 90, .d_m = 0.645},
    {.alpha_deg = -90, .reversed = true},
    {.d_m = 0.120, .theta_deg = -90},
}}};
// clang-format on

} // namespace tappet::motion::robots

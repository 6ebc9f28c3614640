// The options of every program that hunts by seeds.
#pragma once

#include "toolchain/command_line.hpp"

namespace tappet::swarm_options {

inline constexpr Option findings{.name = "--findings",
                                 .value = "N",
                                 .help = "ends after N broken seeds (default 10)",
                                 .is_number = true,
                                 .least = 1};
inline constexpr std::uint64_t usual_findings = 10; // more findings would repeat themselves
inline constexpr Option from{
    .name = "--from", .value = "SEED", .help = "the first seed (default 1)", .is_number = true};
inline constexpr Option step{.name = "--step",
                             .value = "N",
                             .help = "step from one seed to the next (default 1)",
                             .is_number = true,
                             .least = 1};
inline constexpr Option help{"--help", "", "this text"};

} // namespace tappet::swarm_options

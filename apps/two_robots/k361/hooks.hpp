// Lets the host's program read both machines for the picture of their run.
#pragma once

#include "apps/two_robots/host/picture.hpp"
#include "apps/two_robots/k361/plant.hpp"
#include "kernel/os/terminal.hpp"
#include "toolchain/machine/host_hooks.hpp"

namespace two_robots::k361 {

inline void look(MachineInstance& machine, tappet::Plant& plant, Time) {
    auto& cell = static_cast<Plant&>(plant);
    cell.note(state_of(machine, "robot"), state_of(cell.body_robot().instance(), "robot"));
}

inline Sentence draw_picture(const tappet::Plant& plant) {
    const auto& cell = static_cast<const Plant&>(plant);
    if (cell.picture.empty() || os::replace_file(cell.picture.c_str(), picture_of(cell.moments()))) return {};
    return Sentence{"the picture cannot be written to \"", cell.picture,
                    "\"; name a file in a folder that exists"};
}

inline constexpr HostHooks host_hooks{
    .in_real_time = true, .look_every = Plant::noted_every, .look = &look, .ended = &draw_picture};

} // namespace two_robots::k361

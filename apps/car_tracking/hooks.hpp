// Lets the host's program read the machine for the picture of its run.
#pragma once

#include "apps/car_tracking/host/picture.hpp"
#include "apps/car_tracking/plant.hpp"
#include "kernel/os/terminal.hpp"
#include "toolchain/machine/host_hooks.hpp"

namespace tappet::car_tracking {

inline void look(MachineInstance& machine, tappet::Plant& room, Time now) {
    auto& plant = static_cast<Plant&>(room);
    plant.record.look(machine, plant.scene, now);
}

inline Sentence draw_picture(const tappet::Plant& room) {
    const auto& plant = static_cast<const Plant&>(room);
    if (plant.picture.empty() ||
        os::replace_file(plant.picture.c_str(), picture_of(plant.record.moments(), plant.record.looks())))
        return {};
    return Sentence{"the picture cannot be written to \"", plant.picture,
                    "\"; name a file in a folder that exists"};
}

inline constexpr HostHooks host_hooks{.look_every = Record::every, .look = &look, .ended = &draw_picture};

} // namespace tappet::car_tracking

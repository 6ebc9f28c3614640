// A driver whose stop did not reach its device.
#pragma once

#include "kernel/machine/worlds/virtual_world.hpp"

#include <gtest/gtest.h>

namespace tappet::test {

/// The activity of row 0, which runs `driver`, is stopped, and whoever asked is told.
inline void stop_unheard(VirtualWorld& world, MachineInstance& instance, std::string_view driver) {
    EXPECT_EQ(world.change_activity(0, LifeChange::stop).view(),
              (Sentence{"component \"", driver,
                        "\" has stopped, but its safe values did not reach its device; see that the device "
                        "answers, then start and "
                        "stop it, or stop the machine: its guardian writes them too"}
                   .view()));
    EXPECT_EQ(instance.life().left_unsafe(), driver);
}

} // namespace tappet::test

// The phases of a machine's life as types: what a function needs the machine to be, its caller has to show.
#pragma once

namespace tappet {

/// No activity runs, and none of its threads was given up: nobody else touches a component. Given by a world,
/// and by the configuring; good until the next start.
class Standing {
    friend class MachineInstance;
    constexpr Standing() noexcept = default;
};

/// The box was found fit, the heap is sealed, the memory locked and the threads wait. Given by RealWorld.
class Armed {
    friend class RealWorld;
    constexpr Armed() noexcept = default;
};

} // namespace tappet

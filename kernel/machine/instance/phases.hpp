// The phases of a machine's life as types: the caller of a function proves that the machine is in the
// required phase.
#pragma once

namespace tappet {

/// Proof that no activity runs, and that no thread of one was given up: nobody else touches a component.
/// Issued by a world, and by the configuring; valid until the next start.
class Standing {
    friend class MachineInstance;
    constexpr Standing() noexcept = default;
};

/// Proof that the box is fit, the heap sealed, the memory locked and the threads waiting. Issued by
/// RealWorld.
class Armed {
    friend class RealWorld;
    constexpr Armed() noexcept = default;
};

} // namespace tappet

// Reports why state machines changed or refused a state: one line for each reason, once.
#pragma once

#include "kernel/machine/instance/instance.hpp"

namespace tappet {

/// Reads the latest news of the state machines in the table's behaviours. Between two looks, it sees only the
/// last news of each sort.
class ReasonTeller {
public:
    /// Call from the thread that supervises.
    void tell(const MachineInstance& instance, std::string_view speaker);

private:
    struct Told {
        StateMachineExecution::News taken{}, refused{};
    };
    std::array<Told, 16> told_{};
};

} // namespace tappet

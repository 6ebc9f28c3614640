// Why state machines went to their states, or were refused: one line for each reason, once.
#pragma once

#include "kernel/machine/instance/instance.hpp"

namespace tappet {

/// Looks at what the machines of the table's behaviours last told. Between two looks the last one of each
/// sort is seen.
class ReasonTeller {
public:
    /// From the thread that supervises.
    void tell(const MachineInstance& instance, std::string_view speaker);

private:
    struct Told {
        StateMachineExecution::News taken{}, refused{};
    };
    std::array<Told, 16> told_{};
};

} // namespace tappet

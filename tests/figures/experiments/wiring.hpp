// The rows of a machine once more, behind mutexes: what the setting "locked" exchanges its packets through.
#pragma once

#include "kernel/machine/table/machine.hpp"
#include "tests/figures/experiments/task.hpp"

#include <deque>
#include <span>

namespace tappet::experiments {

/// Lives longer than the machine that uses it.
class Wiring {
public:
    /// One channel for each output of the table, one buffer for each buffer row. A row whose writer has the
    /// longer period is filled completely in each execution and emptied one by one; one whose reader has the
    /// longer period the other way round (thesis 4.4.4).
    explicit Wiring(const MachineView& machine);

    /// The ports of a component, and how much it moves at once; nothing else is filled.
    [[nodiscard]] const Assignment& of(std::size_t component) const { return assignments_[component]; }
    /// Data rows and buffer rows.
    [[nodiscard]] std::size_t channels() const { return channels_; }

private:
    std::size_t channels_ = 0;
    std::deque<LockedData<Packet>> data_{};
    std::deque<LockedBuffer<Packet>> buffers_{};
    std::vector<Assignment> assignments_{};
};

} // namespace tappet::experiments

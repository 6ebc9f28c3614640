// The rows of a machine a second time, behind mutexes: the channels of the setting "locked".
#pragma once

#include "kernel/machine/table/machine.hpp"
#include "tests/figures/experiments/task.hpp"

#include <deque>
#include <span>

namespace tappet::experiments {

/// Must outlive the machine that uses it.
class Wiring {
public:
    /// One channel for each output of the table, one buffer for each buffer row. When the writer of a row has
    /// the longer period, each execution fills it completely and the reader takes packets one by one; when
    /// the reader has the longer period, the writer pushes one by one and the reader empties it (thesis
    /// 4.4.4).
    explicit Wiring(const MachineView& machine);

    /// The ports of a component, and its packets at a time; all else stays empty.
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

// The environment of a running program: its component, its data, the links it may act on, and the time.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/component/component.hpp"
#include "kernel/os/stamps.hpp"
#include "kernel/program/table.hpp"

namespace tappet {

/// The addresses behind a LinkRow; filled when the program is bound, before it runs.
struct ProgramLink {
    GatedComponent* component = nullptr;
    void* place = nullptr;       ///< of the facet in the component; of the component itself when it has none
    CommandSlot* slot = nullptr; ///< for a command of another activity
    const ComponentType* type = nullptr; ///< of the component: it must consent before its properties change
};

class ProgramExecution;
/// The programs of a script, contiguous.
struct ProgramsBeside {
    ProgramExecution* first = nullptr;
    std::size_t count = 0;
};

/// Position of a program. Plain data, so that it may be stored and shown.
struct ProgramPosition {
    NodeIndex node = end_node;
    bool acted = false;   ///< the node's action is done; its arcs are evaluated
    bool entered = false; ///< entered_at is valid
    Time entered_at{};
};

/// Time limit in one step for programs in memory: beyond it their activity would miss its deadline, so the
/// rest runs in the next step. Clock time: reading the processor time that a budget claims takes a system
/// call.
struct WorkLimit {
    /// Statements executed between two checks of the time.
    static constexpr std::uint32_t statements = 16;
    os::Stamps* stamps = nullptr; ///< of the activity
    Time until = never;
    bool has_begun = false; ///< a statement was executed: each step executes some, however late it is

    [[nodiscard]] bool is_reached() const noexcept TAPPET_REALTIME {
        return has_begun && until != never && stamps->now() >= until;
    }
};

struct ProgramContext {
    void* component = nullptr;          ///< the component whose engine runs the program
    std::byte* data = nullptr;          ///< see DataLayout; aligned to data_alignment
    const ProgramLink* links = nullptr; ///< by LinkRow
    Time now{};
    ProgramPosition position{};
    void* machines = nullptr;   ///< the state machines that this program may command
    ProgramsBeside beside{};    ///< the programs, including this one
    WorkLimit* limit = nullptr; ///< null: only the number of statements is bounded
};

} // namespace tappet

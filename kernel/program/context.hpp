// What a program meets while it runs: its component, its data, what it may act on, and the time.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/component/component.hpp"
#include "kernel/os/stamps.hpp"
#include "kernel/program/table.hpp"

namespace tappet {

/// The addresses behind a LinkRow; filled when the program is bound, before it runs.
struct ProgramLink {
    GatedComponent* component = nullptr;
    void* place = nullptr;       ///< of the facet in the component; the component itself where it has none
    CommandSlot* slot = nullptr; ///< of a command of another activity
    const ComponentType* type = nullptr; ///< of the component: it is asked before its properties change
};

class ProgramExecution;
/// The programs of a script, which stand side by side.
struct ProgramsBeside {
    ProgramExecution* first = nullptr;
    std::size_t count = 0;
};

/// Where a program stands. Plain data, so that it may be kept and shown.
struct ProgramPosition {
    NodeIndex node = end_node;
    bool acted = false;   ///< the node's action is done; its arcs are asked
    bool entered = false; ///< entered_at holds
    Time entered_at{};
};

/// Until when programs in memory may work in one step: then their activity would miss its deadline, and what
/// is left goes on in the next step. Time of the clock: the processor time that a budget claims takes a
/// system call to read.
struct WorkLimit {
    /// That are executed between two looks at the time.
    static constexpr std::uint32_t statements = 16;
    os::Stamps* stamps = nullptr; ///< of the activity
    Time until = never;
    bool has_begun = false; ///< something is executed in each step, however late it comes to it

    [[nodiscard]] bool is_reached() const noexcept TAPPET_REALTIME {
        return has_begun && until != never && stamps->now() >= until;
    }
};

struct ProgramContext {
    void* component = nullptr;          ///< whose engine runs it
    std::byte* data = nullptr;          ///< see DataLayout; aligned to data_alignment
    const ProgramLink* links = nullptr; ///< by LinkRow
    Time now{};
    ProgramPosition position{};
    void* machines = nullptr;   ///< the state machines that this one may command
    ProgramsBeside beside{};    ///< the programs, itself among them
    WorkLimit* limit = nullptr; ///< null: only the number of statements is bounded
};

} // namespace tappet

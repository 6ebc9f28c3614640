// The component that switches between chains of which one runs (thesis 3.1.3, 4.2: the switch looks atomic to
// all others).
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/control/turns.hpp"
#include "kernel/program/operator_kinds.hpp"

namespace tappet {

/// In the table: component<ChainSwitch>("mode"), first in the activity of its level, and the row
/// exclusive("mode", ...). `do mode.run("jog")` in a script, uses("panel.jog", "mode.run") in a row.
///
/// A hand-over happens at the beginning of a cycle: members of the next chain start from the values that they
/// read and take over shared outputs, members of the last chain stop; then the cycle's steps run. When a
/// member cannot start because an input has no valid value, or because an earlier start() did not write what
/// it reads, nothing changes. Real-time.
class ChainSwitch {
public:
    Output<ScriptText> chain;    ///< the running chain
    Output<ScriptText> hindered; ///< "component.input" that prevented the last hand-over
    Event<> handed_over;
    Event<> fell_back;

    void start(const Cycle&) noexcept TAPPET_REALTIME;
    void step(const Cycle&) noexcept TAPPET_REALTIME;
    /// Ends switching: no chain runs.
    void stop(const Cycle&) noexcept TAPPET_REALTIME;

    bool run(const ScriptText& name) noexcept TAPPET_REALTIME;
    CommandProgress has_run(const ScriptText& name) noexcept TAPPET_REALTIME;
    bool is_running(const ScriptText& name) const noexcept TAPPET_REALTIME;

    /// Called at start-up, by the section. `turns` must outlive the component.
    void place(control_detail::Turns& turns) noexcept { turns_ = &turns; }

    static constexpr auto interface() {
        return facets(
            output<&ChainSwitch::chain>("chain", "", "the one that runs"),
            output<&ChainSwitch::hindered>(
                "hindered", "", "\"component.input\" without which the last hand-over did not happen"),
            event<&ChainSwitch::handed_over>("handed_over", "another chain runs, as requested"),
            event<&ChainSwitch::fell_back>("fell_back", "a part of the chain failed; the first one runs"),
            command<&ChainSwitch::run, &ChainSwitch::has_run>(
                "run", "the chain of that name, in place of the one that runs; failed: it cannot start"),
            method<&ChainSwitch::is_running>("is_running", "that chain runs", any_thread));
    }

private:
    /// Returns the part that prevents it; nobody: it is done.
    std::uint32_t take_over(std::size_t next) noexcept TAPPET_REALTIME;
    void tell() noexcept TAPPET_REALTIME;

    control_detail::Turns* turns_ = nullptr;
    std::size_t wanted_ = 0;
    bool is_first_step_ = true;
};

} // namespace tappet

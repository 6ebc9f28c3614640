// Prints a state machine's news since the last look as lines for the console.
#include "toolchain/machine/reasons.hpp"

#include "kernel/os/terminal.hpp"

namespace tappet {

namespace {

/// Returns the transition of news that were not reported yet; null: there are none.
const TransitionRow* take(StateMachineExecution::News news, StateMachineExecution::News& told,
                          std::span<const TransitionRow> rows) {
    const bool is_new = news != told;
    told = news;
    // For the final state, the machine's own stop reports the reason.
    return is_new && news.transition < rows.size() ? &rows[news.transition] : nullptr;
}

void say(std::string_view speaker, std::string_view component, std::string_view goes,
         const TransitionRow& row, std::string_view reason) {
    const std::string_view to = row.to.empty() ? row.from : row.to;
    os::print(Sentence{speaker, ": the ", component, goes, " \"", to, "\": ", reason, "\n"}.view());
}

} // namespace

void ReasonTeller::tell(const MachineInstance& instance, std::string_view speaker) {
    const auto behaviours = instance.machine().table.behaviours;
    for (std::size_t b = 0; b < std::min(behaviours.size(), told_.size()); ++b) {
        const std::string_view component = behaviours[b].component;
        const StateMachineExecution* machine = instance.state_machine_of(component);
        if (machine == nullptr) continue;
        const auto rows = machine->machine().table.transitions;
        if (const TransitionRow* row = take(machine->refusals(), told_[b].refused, rows))
            say(speaker, component, " does not go to", *row, row->refusal.text);
        if (const TransitionRow* row = take(machine->news(), told_[b].taken, rows))
            say(speaker, component, " goes to", *row, row->because);
    }
}

} // namespace tappet

// One state machine as a process of a Promela model: its variables and the text of its steps.
#pragma once

#include "toolchain/tools/chart/program_text.hpp"
#include "toolchain/tools/chart/promela.hpp"

#include <functional>
#include <string>
#include <vector>

namespace tappet::chart {

/// Functions of the composition: the text of an emission, an operation and a C++ program; the condition of a
/// C++ guard, empty when it is free.
struct ModelWords {
    std::function<std::string(const std::string& event)> emit;
    std::function<std::string(const std::string& operation)> operation;
    std::function<std::string(StateProgram)> program;
    std::function<std::string(StateGuard)> guard;
};

class MachineModel {
public:
    MachineModel(const Chart& chart, const ModelWords& words);

    /// Returns full names, "component.event", by trigger number.
    [[nodiscard]] const std::vector<std::string>& triggers() const { return triggers_; }
    [[nodiscard]] std::string prefix() const { return m_; }
    /// Returns a condition that is true in the states that hear the event.
    [[nodiscard]] std::string hears(std::size_t trigger) const;
    [[nodiscard]] std::string declarations() const;
    [[nodiscard]] std::string process();
    [[nodiscard]] std::string at_final() const { return in(names_.final_state); }

private:
    struct Guard {
        std::string model;    ///< its known part; empty: nothing is known, it always holds
        bool is_free = false; ///< a part of it is unknown: it may also be false
    };
    [[nodiscard]] std::string in(StateIndex state) const;
    [[nodiscard]] std::string active(std::size_t region) const { return m_ + "_r" + std::to_string(region); }
    [[nodiscard]] std::string kept_active(std::size_t region) const {
        return m_ + "_h" + std::to_string(region);
    }
    [[nodiscard]] std::string mark(const std::string& what) const { return " /* " + what + " */"; }
    [[nodiscard]] std::string transition_mark(std::size_t t) const;

    [[nodiscard]] bool needs_history(std::size_t region) const;
    [[nodiscard]] bool has_runs() const;
    void ask(Guard& guard, ConditionRef condition) const;
    [[nodiscard]] Guard guard_of(std::size_t t) const;
    [[nodiscard]] std::vector<StateIndex> entered_by(StateIndex from, StateIndex to) const;

    std::string program(ProgramRef what, bool is_run);
    std::string graph(ProgramIndex number, bool is_run);
    std::string node(const ProgramText& reader, NodeIndex number, const std::string& label, bool is_run);
    std::string statement(const ProgramText& reader, const Statement& what, const std::string& on_error);
    std::string any_value(const ProgramText& reader, DataOffset at, bool or_none) const;
    std::string exit_region(std::size_t region);
    std::string enter(StateIndex state);
    std::string enter_inside(StateIndex state, EntryKind kind);
    std::string enter_path(std::size_t kept, StateIndex target, EntryKind kind);
    std::string take(StateIndex from, StateIndex to, ProgramRef then, EntryKind kind);
    std::string captures(const TransitionRow& row) const;
    std::string conditions();
    std::string on_event(std::size_t trigger);
    std::string try_transition(std::size_t t);
    std::string runs();
    std::string requests();
    [[nodiscard]] std::string free_of_taken(StateIndex state) const;
    [[nodiscard]] std::string note_taken(StateIndex state) const;
    [[nodiscard]] std::string resumes() const;

    const Chart& chart_;
    const ModelWords& words_;
    StateHierarchy names_;
    Regions regions_;
    std::string m_;
    std::vector<std::string> triggers_;
    std::vector<DataOffset> variables_; ///< the variables that the model keeps
    std::vector<std::string> waits_;    ///< labels at which a run program may be interrupted
    std::size_t labels_ = 0;
};

} // namespace tappet::chart

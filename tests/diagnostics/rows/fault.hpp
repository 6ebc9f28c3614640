// A golden row: a fault, planted into a good machine, and the sentence that refuses it. The check runs on the
// rows as in the compiler; tests/diagnostics/cases show that its sentence reaches a compiler's message.
#pragma once

#include "kernel/control/control.hpp"
#include "kernel/limits/held_in.hpp"
#include "kernel/services/reporting/check.hpp"
#include "tests/diagnostics/copy.hpp"

#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace tappet::diagnostics {

/// The section control(...) with rows that a fault may change. It is checked but never started.
struct ControlRows final : ExtraSection {
    std::vector<LevelRow> levels;
    std::vector<RoleRow> processes;
    std::vector<ExclusiveRow> exclusives;
    std::vector<LoopRow> loops;

    [[nodiscard]] control_detail::ControlView rows() const { return {levels, processes, exclusives, loops}; }
    [[nodiscard]] bool take_turns(const MachineView& m, std::size_t one, std::size_t other) const override {
        return control_detail::take_turns(exclusives, m.components[one].name, m.components[other].name);
    }
    [[nodiscard]] Sentence check(const MachineView& m, const TableIndexView& r) const override {
        return control_detail::check(rows(), m, r);
    }
    [[nodiscard]] std::size_t bytes(const MachineView&) const override { return 0; }
    void connect(MachineInstance&, std::size_t, std::span<std::byte>) const override {}
    [[nodiscard]] Sentence describe_stop(std::size_t) const override { return {}; }
    [[nodiscard]] SectionCount counted(std::span<const std::byte>, std::size_t) const noexcept override {
        return {};
    }
};

/// The section reporting(...), also checked but never started.
struct ReportRows final : ExtraSection {
    std::vector<ReportRow> rows;

    [[nodiscard]] Sentence check(const MachineView& m, const TableIndexView& r) const override {
        return reporting_detail::check(rows, m, r);
    }
    [[nodiscard]] std::string_view stands_once() const override { return "reporting"; }
    [[nodiscard]] std::size_t bytes(const MachineView&) const override { return 0; }
    void connect(MachineInstance&, std::size_t, std::span<std::byte>) const override {}
    [[nodiscard]] Sentence describe_stop(std::size_t) const override { return {}; }
    [[nodiscard]] SectionCount counted(std::span<const std::byte>, std::size_t) const noexcept override {
        return {};
    }
};

/// The sections that a table has.
struct Sections final : ExtraList {
    std::vector<const ExtraSection*> all;
    [[nodiscard]] std::size_t size() const noexcept override { return all.size(); }
    [[nodiscard]] const ExtraSection* at(std::size_t number) const noexcept override { return all[number]; }
};

/// The rows of a machine, its board and its binding; a fault may change them.
struct Table : Copy {
    Board board;
    Binding binding;
    std::vector<StateRow> states;           ///< of the first behaviour
    std::vector<TransitionRow> transitions; ///< of the first behaviour
    bool is_controlled = false;             ///< the section is there
    ControlRows control;
    std::vector<ReportRows> reports; ///< one for each such section
    std::vector<HeldIn> held;

    Table(const MachineView& machine, const Board& on, const Binding& bound);
    /// The sentence with which the check refuses it; empty: it is accepted.
    [[nodiscard]] std::string refusal() const;

    void add(const ComponentRow& row);
    /// Adds a component that runs last in that activity.
    void add(const ComponentRow& row, std::string_view activity);
    void add(const ActivityRow& row);
    void add(const ConnectionRow& row);
    void add(const ReactionRow& row);
    void add(const BehaviourRow& row);

    /// Replaces the row of that name.
    void put(const ComponentRow& row);
    void put(const ActivityRow& row);
    /// Replaces the row into that input.
    void put(const ConnectionRow& row);
    /// Replaces the row of that event, or of that call.
    void put(const ReactionRow& row);
};

/// The machine of small_machine.hpp.
Table small_loom();
/// The machine of peers.hpp: a press, and two desks that call it.
Table mill();

/// A fault as the row of a test spells it: its name, the function that plants it, and the sentence of the
/// check.
struct Fault {
    std::string_view name;
    void (*plant)(Table&);
    std::string_view sentence;
};

/// One row of a test: the fault, and the machine that is good without it.
struct Refused {
    Fault fault;
    Table (*good)();
};
std::ostream& operator<<(std::ostream& out, const Refused& row);

/// refusals_test.cpp states the property of each row.
class Refusal : public testing::TestWithParam<Refused> {};

inline auto planted_into(Table (*good)(), std::span<const Fault> faults) {
    std::vector<Refused> rows;
    for (const Fault& fault : faults) rows.push_back({fault, good});
    return testing::ValuesIn(rows);
}
std::string name_of(const testing::TestParamInfo<Refused>& row);

} // namespace tappet::diagnostics

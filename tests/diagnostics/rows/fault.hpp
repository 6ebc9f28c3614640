// A golden row: a fault, planted into a machine that is good, and the sentence that refuses it. The check
// runs on the rows as in the compiler; that its sentence reaches a compiler's message is what
// tests/diagnostics/cases show.
#pragma once

#include "tests/diagnostics/copy.hpp"

#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace tappet::diagnostics {

/// The rows of a machine, its board and the binding, as a fault may change them.
struct Table : Copy {
    Board board;
    Binding binding;
    std::vector<StateRow> states;           ///< of the first behaviour
    std::vector<TransitionRow> transitions; ///< likewise

    Table(const MachineView& machine, const Board& on, const Binding& bound);
    /// What the check says; empty: it is accepted.
    [[nodiscard]] std::string refusal() const;

    void add(const ComponentRow& row);
    void add(const ActivityRow& row);
    void add(const ConnectionRow& row);
    void add(const ReactionRow& row);
    void add(const BehaviourRow& row);

    /// In place of the row of that name.
    void put(const ComponentRow& row);
    void put(const ActivityRow& row);
    /// In place of the row into that input.
    void put(const ConnectionRow& row);
    /// In place of the row of that event, or of that call.
    void put(const ReactionRow& row);
};

/// The machine of small_machine.hpp.
Table small_loom();
/// The one of peers.hpp: a press, and two desks that call it.
Table mill();

/// As a row of a test spells it: its name, what plants it, and what the check then says.
struct Fault {
    std::string_view name;
    void (*plant)(Table&);
    std::string_view sentence;
};

/// One row of a test: the fault and the machine that is good without it.
struct Refused {
    Fault fault;
    Table (*good)();
};
std::ostream& operator<<(std::ostream& out, const Refused& row);

/// refusals_test.cpp says what holds for each row.
class Refusal : public testing::TestWithParam<Refused> {};

std::vector<Refused> planted_into(Table (*good)(), std::span<const Fault> faults);
std::string name_of(const testing::TestParamInfo<Refused>& row);

} // namespace tappet::diagnostics

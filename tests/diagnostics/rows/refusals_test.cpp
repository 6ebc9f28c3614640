// Every golden row: the machine is good, and with the fault in it the check refuses with that sentence.
#include "tests/diagnostics/peers.hpp"
#include "tests/diagnostics/rows/fault.hpp"

#include <algorithm>
#include <ostream>

namespace tappet::diagnostics {
namespace {

template <class Row>
void put_in_place(std::vector<Row>& section, const Row& row, std::string_view Row::* name) {
    const auto old = std::ranges::find(section, row.*name, name);
    if (old == section.end())
        ADD_FAILURE() << "there is no row of \"" << row.*name << "\" to put another in its place";
    else
        *old = row;
}

} // namespace

void Table::add(const ComponentRow& row) { components.push_back(row); }
void Table::add(const ComponentRow& row, std::string_view activity) {
    add(row);
    const auto by = std::ranges::find(activities, activity, &ActivityRow::name);
    EXPECT_TRUE(by != activities.end() && by->runs.push(row.name)) << "in activity \"" << activity << "\"";
}
void Table::add(const ActivityRow& row) { activities.push_back(row); }
void Table::add(const ConnectionRow& row) { connections.push_back(row); }
void Table::add(const ReactionRow& row) { reactions.push_back(row); }
void Table::add(const BehaviourRow& row) { behaviours.push_back(row); }

void Table::put(const ComponentRow& row) { put_in_place(components, row, &ComponentRow::name); }
void Table::put(const ActivityRow& row) { put_in_place(activities, row, &ActivityRow::name); }
void Table::put(const ConnectionRow& row) { put_in_place(connections, row, &ConnectionRow::to); }
void Table::put(const ReactionRow& row) { put_in_place(reactions, row, &ReactionRow::event); }

Table::Table(const MachineView& machine, const Board& on, const Binding& bound)
    : Copy{machine}, board{on}, binding{bound} {
    if (behaviours.empty()) return;
    const StateMachineTable& cycle = behaviours[0].type.machine;
    states.assign(cycle.states.begin(), cycle.states.end());
    transitions.assign(cycle.transitions.begin(), cycle.transitions.end());
}

std::string Table::refusal() const {
    Copy copy = *this;
    if (!copy.behaviours.empty()) {
        copy.behaviours[0].type.machine.states = states;
        copy.behaviours[0].type.machine.transitions = transitions;
    }
    MachineView view = copy.view();
    Sections sections;
    if (is_controlled) sections.all.push_back(&control);
    for (const ReportRows& each : reports) sections.all.push_back(&each);
    for (const HeldIn& each : held) sections.all.push_back(&each);
    view.extras = &sections;
    return refusal_of(view, board, binding);
}

Table small_loom() { return {small::good_loom.view(), small::good_board, small::good_binding}; }

Table mill() {
    static constexpr auto machine = small::pressing(
        reactions(small::spare_close, small::spare_force, small::desk_close, small::desk_force));
    return {machine.view(), small::mill_board, unbound};
}

std::string name_of(const testing::TestParamInfo<Refused>& row) { return std::string{row.param.fault.name}; }
std::ostream& operator<<(std::ostream& out, const Refused& row) { return out << row.fault.name; }

TEST_P(Refusal, is_the_sentence) {
    Table table = GetParam().good();
    ASSERT_EQ(table.refusal(), "") << "without the fault";
    GetParam().fault.plant(table);
    EXPECT_EQ(table.refusal(), GetParam().fault.sentence);
}

} // namespace tappet::diagnostics

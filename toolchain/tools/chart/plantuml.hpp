// Writes a state machine or a program as a UML state chart in the language of PlantUML, whose tool draws it.
#pragma once

#include "toolchain/tools/chart/chart.hpp"

#include <string>

namespace tappet::chart {

/// Writes states, regions, history and transitions with event, guard, transition program and reason. A note
/// states the transitions that every machine has (thesis 5.2.2: to the final state, and from there to the
/// initial one). For a program alone, writes program_to_plantuml of its only program.
std::string to_plantuml(const Chart& chart);

/// Writes the graph of one program (thesis figure 5.2): nodes with their actions, arcs with their conditions.
std::string program_to_plantuml(const Chart& chart, ProgramIndex program);

} // namespace tappet::chart

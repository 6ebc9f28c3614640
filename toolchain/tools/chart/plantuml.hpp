// A state machine or a program as a UML state chart in the language of PlantUML, whose tool draws it.
#pragma once

#include "toolchain/tools/chart/chart.hpp"

#include <string>

namespace tappet::chart {

/// States, regions, history and transitions with event, guard, transition program and reason. The transitions
/// that every machine has (thesis 5.2.2: to the final state, and from there to the initial one) are told in a
/// note. Of a program alone: program_to_plantuml of its only program.
std::string to_plantuml(const Chart& chart);

/// The graph of one program (thesis figure 5.2): nodes with what they do, arcs with their conditions.
std::string program_to_plantuml(const Chart& chart, ProgramIndex program);

} // namespace tappet::chart

// The options of a machine's chart program; `tappet` reads them before it builds that program.
#pragma once

#include "toolchain/command_line.hpp"

#include <array>

namespace tappet::chart {

inline constexpr std::array chart_options{
    Option{"--to", "DIR", "where the files go (default: here; of tappet chart: build/charts)"},
    Option{"--bit-rate", "N", "bit rate of the drawn buses, bit/s (default: 1000000)", true, 1, 1'000'000},
    Option{"--data-bit-rate", "N", "the same for CAN FD's data phase (default: 2000000)", true, 1,
           10'000'000},
    Option{"--help", "", "this text"}};

/// Its words; without one: svg.
inline constexpr std::array chart_words{
    Option{"svg", "", "the table, each state machine and each program, drawn by the tools dot and plantuml"},
    Option{"bus", "", "the frames of each bus, with their proven response times"},
    Option{"dbc", "", "each CAN bus as a DBC file"},
    Option{"dot", "", "the table as text for dot"},
    Option{"plantuml", "", "a UML state chart of each state machine and each program, as text for plantuml"},
    Option{"scxml", "", "each state machine"},
    Option{"promela", "", "each state machine alone and the machine's state machines together"},
    Option{"verify", "", "searches those models with spin"}};

} // namespace tappet::chart

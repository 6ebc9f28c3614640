// Writes a state machine as SCXML (W3C Recommendation "State Chart XML", 2015).
#pragma once

#include "toolchain/tools/chart/chart.hpp"

#include <string>

namespace tappet::chart {

/// The states are in one root state "<machine>", whose transitions for the events "request.final" and
/// "request.initial" are those that every machine has. Regions are <parallel>; run programs are <invoke>; a
/// time-out is a <send> with a delay upon entry, which exit cancels; an else branch is the next transition of
/// the same event. Programs are elements of the namespace "urn:tappet", guards are texts of the data model
/// "tappet". SCXML runs a transition's content between exits and entries, Tappet before the exits (thesis
/// 5.2.1): a program that executes the file must know this.
std::string to_scxml(const Chart& chart);

} // namespace tappet::chart

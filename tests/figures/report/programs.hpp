// Finds the programs of figures and runs them, each with a limit of time.
#pragma once

#include "tests/figures/report/run.hpp"

#include <expected>
#include <string>
#include <vector>

namespace tappet::figures {

/// One program to run: `figures-exchange` with the name "exchange".
struct Program {
    std::string name;
    std::string path;
    std::string only = {}; ///< the groups whose id contains it; empty: all
};

/// The programs below a build's folder of figures, the floors first, then by name. Or one sentence.
std::expected<std::vector<Program>, std::string> find_programs(const std::string& folder);

/// The selected programs: each word is a program's name, or the prefix of a figure's id ("exchange.local").
/// Otherwise one sentence: the word that fits no program, and the valid ones.
std::expected<std::vector<Program>, std::string> choose(const std::vector<Program>& programs,
                                                        const std::vector<std::string>& wanted);

/// Runs it with those arguments and writes its output to `log`; it is told to write its result to `json`.
/// Never throws: a program that ends with another code than 0, exceeds its time or writes no result gives a
/// failure with the reason and the end of its log.
ProgramRun run_program(const Program& program, const std::vector<std::string>& arguments,
                       const std::string& json, const std::string& log, double seconds_at_most);

/// Ctrl-C and SIGTERM end the running program, with all its children, and then this one with 130.
void end_on_signals();

} // namespace tappet::figures

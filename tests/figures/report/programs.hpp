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
    std::string only = {}; ///< the groups whose id has it; empty: all
};

/// The programs below a build's folder of figures, the floors first, then by name. Or one sentence.
std::expected<std::vector<Program>, std::string> find_programs(const std::string& folder);

/// Those that are wanted: each word is a program's name, or the begin of a figure's id ("exchange.local").
/// Or one sentence: which word fits no program, and which there are.
std::expected<std::vector<Program>, std::string> choose(const std::vector<Program>& programs,
                                                        const std::vector<std::string>& wanted);

/// Runs it with those arguments, what it says in `log`; its result comes from `json`, which it is told to
/// write. Never throws: a program that ends otherwise than with 0, exceeds the seconds or writes no result
/// comes back with a failure that says so and how its log ended.
ProgramRun run_program(const Program& program, const std::vector<std::string>& arguments,
                       const std::string& json, const std::string& log, double seconds_at_most);

/// Ctrl-C and SIGTERM end the program that runs, with all that it started, and then this one with 130.
void end_on_signals();

} // namespace tappet::figures

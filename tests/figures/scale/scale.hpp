// The measurements of figures-scale: machines of several sizes, compiled by both compilers, linked, started
// and run; a system; a jacquard head.
#pragma once

#include "tests/figures/measure/candidates.hpp"

#include <expected>
#include <map>
#include <string>
#include <vector>

namespace tappet::figures {

/// The compilers and flags of this program's tree: words by name, from the file that CMake wrote.
using Toolset = std::map<std::string, std::vector<std::string>>;
std::expected<Toolset, std::string> read_toolset(const std::string& file);

/// Adds figures, plots and goals; the notes name impossible measurements.
void measure_growth(const Options& options, const Toolset& tools, Result& result);
/// Does the same for the compilation of one machine of a system: ten on one wire, with a hundred rows across.
void measure_system(const Options& options, const Toolset& tools, Result& result);
std::vector<Group> jacquard_groups();

} // namespace tappet::figures

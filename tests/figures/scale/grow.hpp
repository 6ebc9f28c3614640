// Machines of several sizes: compiled by both compilers, linked, started and run.
#pragma once

#include "tests/figures/measure/candidates.hpp"

#include <expected>
#include <map>
#include <string>
#include <vector>

namespace tappet::figures {

/// How the tree that this program belongs to compiles and links: words by name, from the file CMake wrote.
class Toolset {
public:
    static std::expected<Toolset, std::string> read(const std::string& file);
    [[nodiscard]] const std::vector<std::string>& words(const std::string& name) const;

private:
    std::map<std::string, std::vector<std::string>> words_{};
};

/// Which sizes are compiled by which compiler.
struct Growth {
    std::vector<std::size_t> sizes;          ///< by the tree's own compiler, linked and run
    std::vector<std::size_t> sizes_of_clang; ///< compiled by clang as well
};
Growth growth(const Options& options);

/// Adds figures, plots and goals; what could not be done goes into the notes.
void measure_growth(const Options& options, const Toolset& tools, Result& result);
/// Likewise, of compiling one machine of a system: ten on one wire, with a hundred rows across.
void measure_system(const Options& options, const Toolset& tools, Result& result);

} // namespace tappet::figures

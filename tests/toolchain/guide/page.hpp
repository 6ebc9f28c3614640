// A page of the guide as its machine's project, which the page begins, edits and spoils step by step. Its
// blocks are fenced, or in a comment that no reader sees (<!-- cpp ... -->):
//     sh              commands; `tappet new NAME ..` begins the project from the front door's templates
//     cpp FILE, osd FILE, cmake FILE      a whole file of the project
//     diff FILE       lines of a file, in place of others
//     cpp             code beside the project, in its namespace
//     text refused    the block before it is refused with this sentence, and undone
//     text incomplete the same, but it stays: a later block brings what is missing
#pragma once

#include <cstddef>
#include <expected>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::guide {

struct Block {
    std::string language{}, argument{};
    std::string text{}; ///< whole lines
    std::size_t line = 0;
};

/// In the page's order. An error names the line and the cure.
std::expected<std::vector<Block>, std::string> blocks(std::string_view page);

/// A machine's folder at one point of a page, and the compiler's expected answer there.
struct Project {
    std::string name;                         ///< of the machine, and of its namespace
    std::map<std::string, std::string> files; ///< by their paths from the folder
    std::string code;                         ///< beside them
    bool operator==(const Project&) const = default;
};
struct Unit {
    Project project;
    std::string refusal;  ///< empty: it compiles
    std::string changed;  ///< the file of the block that is refused; empty: code
    bool compiles = true; ///< false: only CMake reads what the page changed
    std::size_t line = 0; ///< line in the page
};
struct Page {
    std::vector<Unit> units; ///< the refused ones, then the whole, unless it is unchanged
    std::vector<std::string> commands;
};
std::expected<Page, std::string> read_page(std::string_view text, const std::filesystem::path& templates);

/// Writes a unit as a case of tests/diagnostics, <to>/<name>.cpp, with its project in <to>/<name>/.
void write_unit(const Unit& unit, const std::filesystem::path& to, const std::string& name,
                const std::string& page);

} // namespace tappet::guide

// A machine's project: writes it from templates, and reads the names of its machines.
#pragma once

#include <expected>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::front {

struct Choice {
    std::string name{}; ///< of the folder, the namespace and the programs
    bool can = false;
    bool modbus = false;
    bool cam = false;
};

/// Writes the project into a new folder of that name; leaves out files without a line. Returns empty on
/// success; otherwise the fault and its cure.
[[nodiscard]] std::string write_project(const std::filesystem::path& templates, const Choice& choice);

/// Fills in a template's text for a choice: @NAME@ and @TITLE@ stand for its names. A line that begins with
/// @can, @modbus, @cam, @bus (CAN, for a drive or a shaft) or @map (any of them) is kept if it was chosen,
/// one with @nocan and so on if not; a line with several is kept if all apply.
[[nodiscard]] std::string filled(std::string_view text, const Choice& choice);

/// Returns the name of each tappet_machine(..) of a project, at least one. The error includes the cure.
[[nodiscard]] std::expected<std::vector<std::string>, std::string>
machines_of(const std::filesystem::path& cmake);

/// Returns the names of a machine's boards, as in its programs: for boards/my_box.hpp, my_box.
[[nodiscard]] std::vector<std::string> boards_of(const std::filesystem::path& cmake,
                                                 std::string_view machine);

/// Returns whether a source in the folder names an option, as the machine's plant may. Skips built files.
[[nodiscard]] bool has_option(const std::filesystem::path& folder, std::string_view option);

} // namespace tappet::front

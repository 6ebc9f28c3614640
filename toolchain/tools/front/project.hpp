// A machine's project: written from templates, and its machine's name read back.
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

/// Into a folder of that name, which is not there yet; files without a line are left out. Empty: it is
/// written; else what is wrong and the cure.
[[nodiscard]] std::string write_project(const std::filesystem::path& templates, const Choice& choice);

/// A template's text for a choice: @NAME@ and @TITLE@ stand for its names; a line that begins with @can,
/// @modbus, @cam or @bus (of CAN, for one of the two) is there with it, one with @nocan and so on without it;
/// with several when all are so.
[[nodiscard]] std::string filled(std::string_view text, const Choice& choice);

/// Of each tappet_machine(..) of a project, one at least. The error names the cure.
[[nodiscard]] std::expected<std::vector<std::string>, std::string>
machines_of(const std::filesystem::path& cmake);

/// The names of a machine's boards, as its programs have them: of boards/my_box.hpp it is my_box.
[[nodiscard]] std::vector<std::string> boards_of(const std::filesystem::path& cmake,
                                                 std::string_view machine);

/// Whether a source in the folder names an option, as a plant of its own does. What was built is passed over.
[[nodiscard]] bool has_option(const std::filesystem::path& folder, std::string_view option);

} // namespace tappet::front

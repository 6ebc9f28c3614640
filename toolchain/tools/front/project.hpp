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
};

/// Into a folder of that name, which is not there yet. Empty: it is written; else what is wrong and the cure.
[[nodiscard]] std::string write_project(const std::filesystem::path& templates, const Choice& choice);

/// A template's text for a choice: @NAME@ and @TITLE@ stand for its names; a line that begins with @can or
/// @modbus is there with it, one with @nocan or @nomodbus without it.
[[nodiscard]] std::string filled(std::string_view text, const Choice& choice);

/// Of the first tappet_machine(..) of a project. The error names the cure.
[[nodiscard]] std::expected<std::string, std::string> machine_of(const std::filesystem::path& cmake);

/// ", did you mean ...": empty when none is near.
[[nodiscard]] std::string suggestion(std::string_view word, const std::vector<std::string>& names);

} // namespace tappet::front

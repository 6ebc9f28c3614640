// Reads a result back from its JSON: the report does, and the tests of the programs.
#pragma once

#include "tests/figures/measure/result.hpp"

#include <expected>
#include <string>
#include <string_view>

namespace tappet::figures {

/// Or one sentence: what is wrong with the text, called `name`. A number that is no number (JSON's null)
/// comes back as NaN: a goal with one is missed.
std::expected<Result, std::string> parse_result(std::string_view text, const std::string& name);
/// Or one sentence: the file is not there, empty or broken.
std::expected<Result, std::string> read_result(const std::string& path);

} // namespace tappet::figures

// The time that a machine's activities took, from the summary of a run.
#pragma once

#include <expected>
#include <string>

namespace tappet::front {

/// Returns one line per activity: processor time and its row's claim, response and its deadline. The error
/// states the fault in the summary's text.
[[nodiscard]] std::expected<std::string, std::string> figures_of(const std::string& summary);

} // namespace tappet::front

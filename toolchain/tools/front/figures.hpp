// What a machine's activities took, from the summary of a run.
#pragma once

#include <expected>
#include <string>

namespace tappet::front {

/// A line for each activity: processor time beside what its row claims, response beside its deadline. The
/// error is what is wrong with the summary's text.
[[nodiscard]] std::expected<std::string, std::string> figures_of(const std::string& summary);

} // namespace tappet::front

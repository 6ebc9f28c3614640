// One run as a self-contained page, report.html with the run's JSON in it: no network, no other file.
#pragma once

#include "tests/figures/report/run.hpp"

#include <expected>
#include <string>

namespace tappet::figures {

/// Returns the page for a merged run; otherwise one sentence: report.html is missing or has no place for it.
std::expected<std::string, std::string> page(const std::string& merged_run);

/// A short version for a terminal.
std::string summary_text(const Run& run);

} // namespace tappet::figures

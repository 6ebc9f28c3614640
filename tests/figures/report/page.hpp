// One run as a self-contained page: no network, no script, no other file.
#pragma once

#include "tests/figures/report/run.hpp"

#include <string>

namespace tappet::figures {

/// Returns the page's text. gnuplot's files are in `folder`; when it draws nothing, the page says so.
std::string page(const Run& run, const std::string& folder);

/// A short version for a terminal.
std::string summary_text(const Run& run);

} // namespace tappet::figures

// One run as one page that needs nothing beside itself: no network, no script, no file.
#pragma once

#include "tests/figures/report/run.hpp"

#include <string>

namespace tappet::figures {

/// The page's text. gnuplot's files stand in `folder`; when it draws nothing the page says so.
std::string page(const Run& run, const std::string& folder);

/// The same in short, for a terminal.
std::string summary_text(const Run& run);

} // namespace tappet::figures

// A user's password, from a file or from the terminal.
#pragma once

#include "toolchain/tools/browser/link.hpp"

namespace tappet::browser {

/// Returns the first line of the file that TAPPET_PASSWORD_FILE names; otherwise asks at the terminal,
/// without echo. The failure: a file that others may read, or no terminal.
Result<std::string> ask_password(const std::string& question);

} // namespace tappet::browser

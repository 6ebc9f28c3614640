// A recording as a table (RFC 4180): a line for each time, a column for each channel.
#pragma once

#include "toolchain/tools/browser/mcap.hpp"

namespace tappet::browser {

/// The first column holds the times, in seconds since 1970; a channel without a message at a time has an
/// empty cell. The cell of a message {"value": VALUE} is the value; lists and objects stay JSON.
[[nodiscard]] std::string as_csv(const mcap::Contents& recording);

} // namespace tappet::browser

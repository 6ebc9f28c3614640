// A recording as a table (RFC 4180): a line for each time, a column for each channel.
#pragma once

#include "toolchain/tools/browser/mcap.hpp"

namespace tappet::browser {

/// Times stand in the first column, in seconds since 1970; a channel without a message at a time has an empty
/// cell. Of a message {"value": VALUE} the cell is the value, and what is a list or an object stays JSON.
[[nodiscard]] std::string as_csv(const mcap::Contents& recording);

} // namespace tappet::browser

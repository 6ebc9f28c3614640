// The gateway's process from its options to its end.
#pragma once

#include "toolchain/tools/gateway/options.hpp"

#include <iosfwd>

namespace tappet::network {

/// Serves until SIGTERM or SIGINT. Prints the address, and what goes wrong. Returns the exit code: 0, or 2
/// after a sentence on `errors`.
[[nodiscard]] int serve(const Options& options, std::ostream& out, std::ostream& errors);

} // namespace tappet::network

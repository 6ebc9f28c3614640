// The options of a simulated loom, as the command line names them.
#pragma once

#include "apps/carpet_loom/plant/settings.hpp"

#include <string_view>

namespace tappet::loom {

/// Returns true when the option's value is valid, and stores it in `to`. `known`: the option exists.
[[nodiscard]] bool read_option(std::string_view word, std::string_view value, Settings& to, bool& known);
[[nodiscard]] std::string_view usage();

} // namespace tappet::loom

// The options of a simulated loom, as a command line names them.
#pragma once

#include "apps/carpet_loom/plant/settings.hpp"

#include <string_view>

namespace tappet::loom {

/// True when the option's value is right, and then it is in `to`; `known`: there is such an option.
[[nodiscard]] bool read_option(std::string_view word, std::string_view value, Settings& to, bool& known);
[[nodiscard]] std::string_view usage();

} // namespace tappet::loom

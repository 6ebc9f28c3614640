// SPDX-License-Identifier: Apache-2.0
// Where settings and learned values lie on the data partition: each layout of properties has its own folder,
// so that a version that knows fewer loses none of the others'.
#pragma once

#include "board/init/system.hpp"

#include <string>

namespace tappet::box {

/// Where the data partition is mounted: settings, learned values, black boxes, what was said.
inline constexpr const char* data_folder = "/var/lib/tappet";

[[nodiscard]] std::string properties_folder(const std::string& layout);

/// The layout that was in use last, and proven: a trial that fails has changed nothing of it. Empty: none
/// yet.
[[nodiscard]] std::string last_layout();
[[nodiscard]] init::Done note_layout(const std::string& layout);

} // namespace tappet::box

// SPDX-License-Identifier: Apache-2.0
// The folders of settings and learned values on the data partition: one for each layout of properties, so
// that an older version with fewer properties does not lose the others.
#pragma once

#include "board/init/system.hpp"

#include <string>

namespace tappet::box {

/// Mount point of the data partition: settings, learned values, black boxes, the log.
inline constexpr const char* data_folder = "/var/lib/tappet";

[[nodiscard]] std::string properties_folder(const std::string& layout);

/// Returns the last layout in use by a proven version; a failed trial does not change it. Empty: none yet.
[[nodiscard]] std::string last_layout();
[[nodiscard]] init::Done note_layout(const std::string& layout);

} // namespace tappet::box

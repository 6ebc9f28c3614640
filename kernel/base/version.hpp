// The version of Tappet. CMakeLists.txt reads it here.
#pragma once

#include <string_view>

namespace tappet {

inline constexpr std::string_view framework_version = "0.15";

} // namespace tappet

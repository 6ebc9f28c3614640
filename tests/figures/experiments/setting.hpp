// The five settings that each application runs in: how its activities communicate.
#pragma once

#include "kernel/base/type_tag.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace tappet {

namespace experiments {

enum class Setting : std::uint8_t { none, locked, data, commands, events };
inline constexpr std::array<std::string_view, 5> setting_names{"none", "locked", "data", "commands",
                                                               "events"};

} // namespace experiments

template <>
inline constexpr auto names_of<experiments::Setting> = experiments::setting_names;

} // namespace tappet

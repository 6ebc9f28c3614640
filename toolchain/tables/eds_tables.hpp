// The tables of an EDS or DCF file as constants of C++.
#pragma once

#include "drivers/canopen/eds_reader.hpp"

#include <string>

namespace tappet::tables {

/// Returns definitions of constants, of which `name` is the EdsFile.
[[nodiscard]] std::string to_cpp(const canopen::detail::EdsReader& read, std::string_view name);

} // namespace tappet::tables

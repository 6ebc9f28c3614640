// All faults of an EDS or DCF file, for a program that checks files.
#pragma once

#include "kernel/base/source_text.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tappet::canopen {

struct EdsFault {
    std::uint32_t line = 0;
    std::string meaning{};
    std::string affects{}; ///< the rows that it matters to; "nobody": it is a note
    bool is_fatal = false; ///< nothing can be read from the file
};

/// Returns the faults in the order of their lines; empty: none. Not real-time; allocates.
[[nodiscard]] std::vector<EdsFault> eds_faults(const SourceText& file);

} // namespace tappet::canopen

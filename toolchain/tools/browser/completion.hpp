// Completion of a half-typed line: commands, names that the command takes, options.
#pragma once

#include "toolchain/tools/browser/commands.hpp"

namespace tappet::browser {

struct Completion {
    std::size_t begin = 0;                 ///< of the typed word, in the line
    std::vector<std::string> candidates{}; ///< whole words, sorted
    /// Returns the common prefix of all candidates; at least the typed word when there are any.
    [[nodiscard]] std::string common() const;
};

/// `before_cursor`: the line up to the cursor.
[[nodiscard]] Completion complete(Machines& machines, std::string_view before_cursor);

} // namespace tappet::browser

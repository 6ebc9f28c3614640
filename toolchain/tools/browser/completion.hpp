// What a half-typed line can go on with: commands, names that the command takes, options.
#pragma once

#include "toolchain/tools/browser/commands.hpp"

namespace tappet::browser {

struct Completion {
    std::size_t begin = 0;                 ///< of the word that is typed, in the line
    std::vector<std::string> candidates{}; ///< whole words, sorted
    /// What all candidates begin with; at least what is typed when there are any.
    [[nodiscard]] std::string common() const;
};

/// `before_cursor`: the line up to the cursor.
[[nodiscard]] Completion complete(Machines& machines, std::string_view before_cursor);

} // namespace tappet::browser

// A text file as a constant, which the build made of it: scripts and descriptions that the compiler reads.
#pragma once

#include <string_view>

namespace tappet {

struct SourceText {
    std::string_view name{}; ///< its place in the tree, for messages
    std::string_view text{}; ///< its bytes as they are
};

} // namespace tappet

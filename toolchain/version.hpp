// --version of every program.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/base/version.hpp"

#include <string_view>

#include <unistd.h>

namespace tappet {

/// When --version is the program's only word, prints "PROGRAM: Tappet 0.15" and returns true. Not real-time.
inline bool prints_version(int count, const char* const* words, std::string_view program) {
    if (count != 2 || std::string_view{words[1]} != "--version") return false;
    const Sentence line{program, ": Tappet ", framework_version, "\n"};
    return ::write(STDOUT_FILENO, line.view().data(), line.view().size()) > 0;
}

} // namespace tappet

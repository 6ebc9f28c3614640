// For tests that count their own instructions: they start themselves under callgrind.
#pragma once

#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

namespace tappet::figures {

/// Instructions of all functions measured_* of a program that is started with these words; 0: it did not
/// reach them. callgrind writes its file beside the program; its name ends on `name`.
inline double count_measured(const std::string& program, const std::string& words, const std::string& name) {
    const std::string out = program + "." + name;
    const std::string command =
        "valgrind --tool=callgrind --toggle-collect='measured_*' --callgrind-out-file='" + out + "' '" +
        program + "' " + words + " >/dev/null 2>&1";
    if (std::system(command.c_str()) != 0) return 0;
    std::ifstream file{out};
    for (std::string line; std::getline(file, line);)
        for (const std::string_view word : {"totals: ", "summary: "})
            if (line.starts_with(word)) return std::atof(line.c_str() + word.size());
    return 0;
}

} // namespace tappet::figures

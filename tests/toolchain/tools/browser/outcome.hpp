// tappet-browse in this process: what it printed, and how it ended.
#pragma once

#include "toolchain/tools/browser/program.hpp"

#include <sstream>
#include <string>
#include <vector>

namespace tappet::browser {

struct Outcome {
    int code = -1;
    std::string out{};
    std::string errors{};
};

inline Outcome run_words(const std::vector<std::string>& words, StopFlag* signal = nullptr) {
    std::ostringstream out;
    std::ostringstream errors;
    Surroundings surroundings{out, errors};
    surroundings.signal = signal;
    const int code = run_program(words, surroundings);
    return {code, out.str(), errors.str()};
}

} // namespace tappet::browser

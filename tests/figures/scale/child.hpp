// Another program, run to its end, and the resources that it used.
#pragma once

#include <expected>
#include <string>
#include <vector>

namespace tappet::figures {

struct Used {
    double processor_s = 0; ///< of it and of all it started, user and system
    double memory_mb = 0;   ///< the largest resident size of any of them
    double started_ns = 0;  ///< CLOCK_MONOTONIC, just before it was started
};

/// `words`: the program, found along PATH, and its arguments. Its output goes to `log`. Otherwise one
/// sentence, with the last lines of the output.
std::expected<Used, std::string> run_child(const std::vector<std::string>& words, const std::string& log);

} // namespace tappet::figures

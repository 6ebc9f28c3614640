// Runs spin over a model, and interprets its results by the marks in the model.
#pragma once

#include <string>
#include <vector>

namespace tappet::chart {

struct SpinSearch {
    bool ran = false;      ///< spin, the compiler and the search completed
    bool complete = false; ///< no state of the model was left out
    long errors = -1;
    double states = 0;
    double seconds = 0;
    std::string error;                  ///< the first violation: the assertion with its words
    std::vector<std::string> trail;     ///< the way to it: the marks of the lines on the way
    std::vector<std::string> unreached; ///< marks that no run reaches: "state loom stopped"
    std::string output;
};

/// Returns false when the tool is not installed.
bool has_spin();

/// Searches every run of the model; defines are REQUESTS, FAILURES, STOP. For the host: starts spin and the C
/// compiler in a directory of its own, which it removes.
SpinSearch search(const std::string& model, const std::vector<std::string>& defines);

} // namespace tappet::chart

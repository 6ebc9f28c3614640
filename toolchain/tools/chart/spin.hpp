// Runs spin over a model, and reads what its search found by the marks that the model bears.
#pragma once

#include <string>
#include <vector>

namespace tappet::chart {

struct SpinSearch {
    bool ran = false;      ///< spin, the compiler and the search came to their end
    bool complete = false; ///< no state of the model was left out
    long errors = -1;
    double states = 0;
    double seconds = 0;
    std::string error;                  ///< the first violation: the assertion with the words beside it
    std::vector<std::string> trail;     ///< what led there: the marks of the lines on the way
    std::vector<std::string> unreached; ///< marks that no run comes to: "state loom stopped"
    std::string output;
};

/// False where the tool is not installed.
bool has_spin();

/// Searches every run of the model; defines are REQUESTS, FAILURES, STOP. Made for the host: it starts spin
/// and the C compiler in a directory of its own, which it removes.
SpinSearch search(const std::string& model, const std::vector<std::string>& defines);

} // namespace tappet::chart

// One run of figures: the host, its disturbances, and the result of each program.
#pragma once

#include "tests/figures/measure/result.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tappet::figures {

/// The use of the host during a span, by all its processors together.
struct Usage {
    double seconds = 0;
    double busy_percent = 0;  ///< of all processors
    double steal_percent = 0; ///< taken by the hypervisor for other guests
    double switches_per_second = 0;
    double interrupts_per_second = 0;
};

/// The same work repeated on one undisturbed processor, and continuous readings of the clock.
struct Noise {
    double work_us = 0;         ///< median of the fixed work
    double spread_percent = 0;  ///< its p99 above its median
    double worst_percent = 0;   ///< its longest above its median
    double gaps_per_second = 0; ///< unrequested pauses longer than 1 us
    double longest_gap_us = 0;
    double lost_percent = 0; ///< of the time, in those pauses
};

/// One program's run.
struct ProgramRun {
    std::string name;
    std::string failure =
        {}; ///< empty: it ran to its end; otherwise what happened, and below it the last lines it said
    Result result = {};
    Usage usage = {};
    Noise after = {};
};

struct Run {
    std::string commit; ///< with "and changes" when the tree has uncommitted ones
    std::string when;
    std::string setting;
    std::vector<std::pair<std::string, std::string>> machine = {}; ///< name, value
    Noise before = {};
    std::vector<ProgramRun> programs = {};
};

/// As one JSON text, for archives.
std::string merged(const Run& run);

/// How many goals and statements of a run were held.
struct Score {
    std::size_t goals = 0, held = 0;
    std::size_t statements = 0, true_ones = 0;
    std::size_t programs = 0, failed = 0;
};
Score score(const Run& run);

} // namespace tappet::figures

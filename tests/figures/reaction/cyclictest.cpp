// Runs it and reads the histogram from its JSON, in ns.
#include "tests/figures/reaction/cyclictest.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace tappet::figures::reaction {

Outcome run_cyclictest(int processor, int priority, std::size_t period_us, std::size_t count) {
    Outcome outcome;
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("tappet-cyclictest-" + std::to_string(::getpid()));
    const std::string command =
        "cyclictest --quiet --mlockall --nsecs --threads=1 --histogram=1000000 --affinity=" +
        std::to_string(processor) + " --priority=" + std::to_string(priority) +
        " --interval=" + std::to_string(period_us) + " --loops=" + std::to_string(count) + " --json='" +
        file.string() + "' >/dev/null 2>&1";
    if (std::system(command.c_str()) != 0) {
        outcome.why_not = "cyclictest did not run; it is in the package rt-tests and wants SCHED_FIFO";
        return outcome;
    }
    const auto read = nlohmann::json::parse(std::ifstream{file}, nullptr, false);
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    using Pointer = nlohmann::json::json_pointer;
    const Pointer bins{"/thread/0/histogram"}, longest{"/thread/0/max"}, cycles{"/thread/0/cycles"};
    if (read.is_discarded() || !read.contains(bins)) {
        outcome.why_not = "the JSON of cyclictest has no histogram of its thread";
        return outcome;
    }
    for (const auto& [late, times] : read[bins].items())
        for (std::size_t i = 0; i < times.get<std::size_t>(); ++i)
            outcome.late_ns.add(std::atof(late.c_str()));
    // Beyond the last bin it reports only their number and the longest.
    const std::size_t all = read.value(cycles, outcome.late_ns.count());
    while (outcome.late_ns.count() < all) outcome.late_ns.add(read.value(longest, 0.0));
    return outcome;
}

} // namespace tappet::figures::reaction

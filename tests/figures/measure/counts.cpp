// Starts the program under callgrind, which dumps its counters after each candidate, and reads the dumps.
#include "tests/figures/measure/counts.hpp"

#include <valgrind/callgrind.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <unistd.h>

namespace tappet::figures {

namespace {

constexpr const char* told_to_count = "TAPPET_FIGURES_COUNT";
constexpr std::size_t operations = 2000;

} // namespace

bool counting() { return std::getenv(told_to_count) != nullptr; }

void leave_if_counting(const std::vector<const Group*>& groups) {
    if (!counting()) return;
    for (const Group* group : groups)
        for (const Candidate& candidate : group->candidates) {
            const std::size_t times = candidate.prepare == nullptr ? operations : group->batch;
            const std::size_t rounds = operations / times;
            const std::string name = std::to_string(rounds * times) + " " + group->id + "/" + candidate.name;
            if (candidate.prepare != nullptr) candidate.prepare(times);
            candidate.run(times);
            CALLGRIND_ZERO_STATS;
            for (std::size_t round = 0; round < rounds; ++round) {
                if (candidate.prepare != nullptr) {
                    CALLGRIND_TOGGLE_COLLECT;
                    candidate.prepare(times);
                    CALLGRIND_TOGGLE_COLLECT;
                }
                candidate.run(times);
            }
            CALLGRIND_DUMP_STATS_AT(name.c_str());
        }
    std::_Exit(0);
}

std::map<std::string, double> count_instructions(const char* program, const std::string& only) {
    std::map<std::string, double> counts;
    const std::filesystem::path place =
        std::filesystem::temp_directory_path() / ("tappet-counts-" + std::to_string(::getpid()));
    std::filesystem::create_directories(place);
    const std::string command =
        std::string{told_to_count} + "=1 valgrind --tool=callgrind --callgrind-out-file='" +
        (place / "out").string() + "' '" + program + "'" + (only.empty() ? "" : " --only '" + only + "'") +
        " >'" + (place / "log").string() + "' 2>&1";
    if (std::system(command.c_str()) != 0)
        std::cerr << "instructions were not counted; is valgrind installed? The log:\n"
                  << std::ifstream{place / "log"}.rdbuf() << '\n';
    else
        for (const auto& entry : std::filesystem::directory_iterator{place}) {
            std::ifstream file{entry.path()};
            constexpr std::string_view trigger = "desc: Trigger: Client Request: ", totals = "totals: ";
            std::string name;
            double counted = 1;
            for (std::string line; std::getline(file, line);)
                if (line.starts_with(trigger)) {
                    counted = std::atof(line.c_str() + trigger.size());
                    name = line.substr(line.find(' ', trigger.size()) + 1);
                } else if (line.starts_with(totals) && !name.empty()) {
                    counts[name] = std::atof(line.c_str() + totals.size()) / counted;
                }
        }
    std::filesystem::remove_all(place);
    return counts;
}

} // namespace tappet::figures

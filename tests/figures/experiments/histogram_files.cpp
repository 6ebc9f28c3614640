// Writes block after block.
#include "tests/figures/experiments/findings.hpp"

#include <filesystem>
#include <fstream>

namespace tappet::experiments {

namespace {

struct Block {
    const char* title;
    figures::Samples TaskResult::* samples;
};
constexpr Block blocks[] = {{"periods, us", &TaskResult::periods},
                            {"latencies, us", &TaskResult::latencies},
                            {"data flow of one execution, ns", &TaskResult::exchanges},
                            {"sending a command or emitting an event, ns", &TaskResult::sends},
                            {"serving commands or events, ns", &TaskResult::served}};

void write(std::ostream& file, const Block& block, const TaskResult& task) {
    const figures::Samples& samples = task.*block.samples;
    if (samples.empty()) return;
    const figures::Summary all = samples.summary();
    file << "# " << block.title << ": " << all.count << " samples, median " << all.median << ", mean "
         << all.mean << ", p99 " << all.p99 << ", p99.9 " << all.p999 << ", worst " << all.max << '\n';
    constexpr int bins_in_a_decade = 200;
    for (const auto& [from, count] :
         figures::log_histogram({}, figures::Standing::ours, samples, bins_in_a_decade).points)
        file << from << ' ' << count << '\n';
    file << "\n\n";
}

} // namespace

std::string write_histograms(const Findings& findings, const std::string& directory) {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    for (const Experiment& experiment : findings.all())
        for (const TaskResult& task : experiment.tasks) {
            if (!task.real_time) continue;
            const std::string path =
                directory + "/" + experiment.application + "-" +
                std::string{setting_names[static_cast<std::size_t>(experiment.setting)]} + "-" + task.name +
                ".txt";
            std::ofstream file{path};
            for (const Block& block : blocks) write(file, block, task);
            if (!file.flush()) return "cannot write " + path + "; is the directory yours?";
        }
    return {};
}

} // namespace tappet::experiments

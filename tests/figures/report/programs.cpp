// Children in process groups of their own, so that a hung one is killed with all its children.
#include "tests/figures/report/programs.hpp"

#include "tests/figures/report/surroundings.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::figures {

namespace {

namespace fs = std::filesystem;

volatile std::sig_atomic_t asked_to_end = 0;

std::string end_of(const std::string& log) {
    std::ifstream file{log};
    std::deque<std::string> lines;
    for (std::string line; std::getline(file, line);) {
        lines.push_back(line);
        if (lines.size() > 12) lines.pop_front();
    }
    std::string text;
    for (const std::string& line : lines) text += "\n" + line;
    return text;
}

/// The status from waitpid; -1: it was killed at its time limit.
int run_child(std::vector<std::string> words, const std::string& log, double seconds_at_most) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        setpgid(0, 0);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
        execv(arguments[0], arguments.data());
        _exit(127);
    }
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        const bool late = std::chrono::duration<double>(Clock::now() - begin).count() > seconds_at_most;
        if (late || asked_to_end != 0) {
            kill(-child, SIGKILL);
            waitpid(child, &status, 0);
            if (asked_to_end != 0) std::_Exit(130);
            return -1;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
    return status;
}

std::string failure_of(int status, double seconds_at_most) {
    if (status == -1)
        return "was ended after " + std::to_string(static_cast<int>(seconds_at_most)) + " s, its limit";
    if (WIFSIGNALED(status)) return std::string{"was ended by signal "} + strsignal(WTERMSIG(status));
    if (WEXITSTATUS(status) == 127) return "could not be started";
    return WEXITSTATUS(status) == 0 ? "" : "ended with exit code " + std::to_string(WEXITSTATUS(status));
}

} // namespace

std::expected<std::vector<Program>, std::string> find_programs(const std::string& folder) {
    std::vector<Program> programs;
    std::error_code none;
    const std::string begin = "figures-";
    for (const auto& place : fs::directory_iterator{folder, none})
        for (const auto& file : fs::directory_iterator{place.path(), none}) {
            const std::string name = file.path().filename();
            if (name.starts_with(begin) && file.is_regular_file() && access(file.path().c_str(), X_OK) == 0)
                programs.push_back({name.substr(begin.size()), file.path()});
        }
    if (programs.empty())
        return std::unexpected("no program of figures is below " + folder + "; build the target 'figures'");
    std::ranges::sort(programs, {}, [](const Program& program) {
        return std::pair{program.name != "floors", program.name};
    });
    return programs;
}

std::expected<std::vector<Program>, std::string> choose(const std::vector<Program>& programs,
                                                        const std::vector<std::string>& wanted) {
    if (wanted.empty()) return programs;
    std::vector<Program> chosen;
    for (const std::string& word : wanted) {
        const std::string name = word.substr(0, word.find('.'));
        const auto found = std::ranges::find(programs, name, &Program::name);
        if (found == programs.end()) {
            std::string all;
            for (const Program& program : programs) all += (all.empty() ? "" : ", ") + program.name;
            return std::unexpected("no program of figures is called '" + name + "'; there are " + all);
        }
        chosen.push_back({found->name, found->path, name == word ? "" : word});
    }
    return chosen;
}

ProgramRun run_program(const Program& program, const std::vector<std::string>& arguments,
                       const std::string& json, const std::string& log, double seconds_at_most) {
    ProgramRun run{program.name};
    std::error_code none;
    fs::remove(json, none); // of an earlier run
    std::vector<std::string> words{program.path, "--json", json};
    if (!program.only.empty()) words.insert(words.end(), {"--only", program.only});
    words.insert(words.end(), arguments.begin(), arguments.end());
    const Meter meter;
    run.failure = failure_of(run_child(std::move(words), log, seconds_at_most), seconds_at_most);
    run.usage = meter.usage();
    if (!run.failure.empty()) run.failure += end_of(log);
    auto result = read_result(json);
    if (result)
        run.result = std::move(*result);
    else if (run.failure.empty())
        run.failure = "told no result: " + result.error();
    run.result.program = program.name;
    return run;
}

void end_on_signals() {
    const auto ask = [](int) { asked_to_end = 1; };
    std::signal(SIGINT, ask);
    std::signal(SIGTERM, ask);
}

} // namespace tappet::figures

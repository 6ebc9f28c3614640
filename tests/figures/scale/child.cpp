// fork, exec and wait4, which reports the resources of a child.
#include "tests/figures/scale/child.hpp"

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::figures {

namespace {

double now_ns() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}
double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}
std::string end_of(const std::string& file) {
    std::stringstream all;
    all << std::ifstream{file}.rdbuf();
    const std::string text = all.str();
    return text.size() > 600 ? "..." + text.substr(text.size() - 600) : text;
}

[[noreturn]] void become(const std::vector<std::string>& words, const std::string& log) {
    const int file = ::open(log.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0644);
    if (file < 0 || ::dup2(file, 1) < 0 || ::dup2(file, 2) < 0) ::_exit(127);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::setenv("CCACHE_DISABLE", "1", 1); // a cached compilation must run again
    ::execvp(arguments.front(), arguments.data());
    ::_exit(127);
}

} // namespace

std::expected<Used, std::string> run_child(const std::vector<std::string>& words, const std::string& log) {
    Used used;
    used.started_ns = now_ns();
    const pid_t child = ::fork();
    if (child < 0) return std::unexpected(words.front() + " cannot be started: no process is left; end some");
    if (child == 0) become(words, log);
    int status = 0;
    rusage taken{};
    if (::wait4(child, &status, 0, &taken) != child)
        return std::unexpected(words.front() +
                               " got lost; nothing else may wait for this program's children");
    used.processor_s = seconds(taken.ru_utime) + seconds(taken.ru_stime);
    used.memory_mb = static_cast<double>(taken.ru_maxrss) / 1000;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return used;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
        return std::unexpected(words.front() + " is not there, or cannot write " + log + "; install it");
    return std::unexpected(words.front() + " failed: " + end_of(log));
}

} // namespace tappet::figures

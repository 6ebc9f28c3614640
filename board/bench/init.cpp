// SPDX-License-Identifier: Apache-2.0
// PID 1 of the bench: brings up the box in the manifest (kernel modules, CAN interfaces, GPIO chips), runs
// the manifest's commands in order, sends results to the host and switches off. The guest contains nothing
// else: no shell, no service, nothing that wakes up by itself and disturbs a measurement.

#include "board/bench/host.hpp"
#include "board/init/devices.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace tappet::bench {
namespace {

using namespace init;
using std::chrono::milliseconds;

struct BackgroundCommand {
    std::string name;
    pid_t pid = -1;
    int exit_code = -1; // of a command that ended, until it is read
};

int console = -1;

// Marks in the output stream, for the host only; the same as in bench.cpp.
constexpr char start_of_output = '\x1d';
constexpr char end_of_output = '\x1e';

bool say_to_host(char mark) { return ::write(console, &mark, 1) == 1; }

std::vector<BackgroundCommand> background;

// Splits at blanks; single or double quotes keep blanks. A command that needs a shell must bring one.
std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> words;
    std::string word;
    bool inside = false;
    char quote = 0;
    for (const char c : line) {
        if (quote != 0) {
            if (c == quote)
                quote = 0;
            else
                word += c;
        } else if (c == '\'' || c == '"') {
            quote = c;
            inside = true;
        } else if (c == ' ' || c == '\t') {
            if (inside) words.push_back(word);
            word.clear();
            inside = false;
        } else {
            word += c;
            inside = true;
        }
    }
    if (inside) words.push_back(word);
    return words;
}

std::string base_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

pid_t start(const std::vector<std::string>& words) {
    const auto pid = init::start(words, console, "was it given to the bench with --file or --tool?");
    if (!pid) give_up(pid.error());
    return *pid;
}

void note_end_of(pid_t pid, int code) {
    for (BackgroundCommand& command : background) {
        if (command.pid == pid) {
            command.pid = -1;
            command.exit_code = code;
            results.line("ended " + std::to_string(command.exit_code) + " " + command.name);
        }
    }
}

// PID 1 inherits every orphan, so each wait may see a process other than the one waited for.
int wait_for(pid_t wanted) {
    for (;;) {
        int status = 0;
        const pid_t pid = ::waitpid(-1, &status, 0);
        if (pid == wanted) return to_exit_code(status);
        if (pid > 0)
            note_end_of(pid, to_exit_code(status));
        else if (errno == ECHILD)
            return 127;
    }
}

void collect_ended() { reap(note_end_of); }

int report_misuse(const std::string& message) {
    ::dprintf(console, "bench: %s\n", message.c_str());
    return 2;
}

BackgroundCommand* find_background(const std::string& name) {
    // Returns the last one with this name, so that a command can be started again.
    for (auto command = background.rbegin(); command != background.rend(); ++command)
        if (command->name == name) return &*command;
    return nullptr;
}

// Waits until `wanted` ends, and returns its code; when `other` ends first, returns its code as a failure.
int wait_while(const BackgroundCommand& wanted, const BackgroundCommand& other) {
    while (wanted.pid > 0 && other.pid > 0) {
        int status = 0;
        if (const pid_t pid = ::waitpid(-1, &status, 0); pid > 0) note_end_of(pid, to_exit_code(status));
    }
    if (wanted.pid < 0) return wanted.exit_code;
    ::dprintf(console, "bench: '%s' ended with exit code %d while '%s' was still at work\n",
              other.name.c_str(), other.exit_code, wanted.name.c_str());
    return other.exit_code != 0 ? other.exit_code : 1;
}

int signal_number(const std::string& name) {
    if (name == "TERM" || name.empty()) return SIGTERM;
    if (name == "INT") return SIGINT;
    if (name == "KILL") return SIGKILL;
    if (name == "STOP") return SIGSTOP;
    if (name == "CONT") return SIGCONT;
    if (name == "USR1") return SIGUSR1;
    if (name == "HUP") return SIGHUP;
    return -1;
}

int run_builtin(const std::vector<std::string>& words) {
    const std::string& name = words[0];
    const std::string first = words.size() > 1 ? words[1] : "";
    const std::string second = words.size() > 2 ? words[2] : "";
    if (name == "@sleep") {
        pause_for(milliseconds(static_cast<long>(std::strtod(first.c_str(), nullptr) * 1000)));
        return 0;
    }
    if (name == "@write") {
        if (write_text(first, second)) return 0;
        return report_misuse("@write " + first + ": " + std::strerror(errno));
    }
    if (name == "@link" && (second == "up" || second == "down")) {
        if (!has_interface(first))
            return report_misuse("@link: there is no interface '" + first + "'; ask for it with --can");
        must(set_link(first, second == "up"));
        return 0;
    }
    if (name == "@signal" || name == "@wait") {
        collect_ended();
        BackgroundCommand* command = find_background(first);
        if (command == nullptr)
            return report_misuse(name + ": no command '" + first + "' was started with '&'");
        if (name == "@wait" && second == "while") {
            const BackgroundCommand* other = find_background(words.size() > 3 ? words[3] : "");
            if (other == nullptr)
                return report_misuse("@wait NAME while OTHER: OTHER was not started with '&'");
            return wait_while(*command, *other);
        }
        if (name == "@wait") {
            if (command->pid > 0) {
                const int code = wait_for(command->pid);
                command->pid = -1;
                command->exit_code = code;
            }
            return command->exit_code;
        }
        const int number = signal_number(second);
        if (number < 0) {
            return report_misuse("@signal: unknown signal '" + second +
                                 "'; use TERM INT KILL STOP CONT USR1 HUP");
        }
        if (command->pid < 0) {
            return report_misuse("@signal: '" + first + "' has ended already, with exit code " +
                                 std::to_string(command->exit_code));
        }
        return ::kill(command->pid, number) == 0
                   ? 0
                   : report_misuse("@signal: " + std::string(std::strerror(errno)));
    }
    return report_misuse("unknown step '" + name +
                         "'; use @sleep S, @write PATH TEXT, @link NAME up|down, @signal NAME SIGNAL or "
                         "@wait NAME [while OTHER]");
}

int run(const std::string& line) {
    results.line("start " + line);
    std::vector<std::string> words = split(line);
    bool ignore = false;
    bool in_background = false;
    if (!words.empty() && words.front() == "-") {
        ignore = true;
        words.erase(words.begin());
    }
    if (!words.empty() && words.back() == "&") {
        in_background = true;
        words.pop_back();
    }
    if (words.empty()) return 0;
    int code = 0;
    if (words[0].front() == '@')
        code = run_builtin(words);
    else if (in_background)
        background.push_back({base_name(words[0]), start(words), -1});
    else
        code = wait_for(start(words));
    results.line("done " + std::to_string(code) + " " + line);
    return ignore ? 0 : code;
}

void stop_background() {
    collect_ended();
    const auto running = [] {
        collect_ended();
        return std::ranges::any_of(background,
                                   [](const BackgroundCommand& command) { return command.pid > 0; });
    };
    for (const int number : {SIGTERM, SIGKILL}) {
        for (const BackgroundCommand& command : background) {
            if (command.pid > 0) {
                ::kill(command.pid, number);
                ::kill(command.pid, SIGCONT);
            }
        }
        for (int attempt = 0; attempt < 200 && running(); ++attempt) pause_for(milliseconds(10));
    }
}

void hand_over(const std::string& path) {
    if (::access(path.c_str(), R_OK) != 0) {
        results.line("missing " + path);
        return;
    }
    const std::string bytes = read_text(path);
    results.line("file " + std::to_string(bytes.size()) + " " + path);
    results.write_all(bytes);
}

/// The host's manifest for this bench, line by line.
struct Manifest {
    std::vector<std::string> modules, commands, files;
    std::vector<std::pair<std::string, std::string>> devices;
};
Manifest read_manifest(const std::string& text) {
    Manifest wanted;
    for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
        const std::string line = text.substr(at, end - at);
        const std::size_t blank = line.find(' ');
        const std::string kind = line.substr(0, blank);
        const std::string rest = blank == std::string::npos ? "" : line.substr(blank + 1);
        if (kind == "module")
            wanted.modules.push_back(rest);
        else if (kind == "run")
            wanted.commands.push_back(rest);
        else if (kind == "collect")
            wanted.files.push_back(rest);
        else
            wanted.devices.emplace_back(kind, rest);
    }
    return wanted;
}

void set_up(const std::string& kind, const std::string& rest) {
    if (kind == "can") {
        must(create_can(rest));
    } else if (kind == "gpio") {
        const std::size_t blank = rest.find(' ');
        must(create_gpio_chip(rest.substr(0, blank), rest.substr(blank + 1)));
    } else if (kind == "camera") { // one, as on USB: its other devices would only take time
        must(load_module(rest, "node_types=1 num_inputs=1 input_types=0"));
    } else if (kind == "unthrottled") {
        if (const auto stopped = stop_throttling(); !stopped) give_up(stopped.error());
    } else if (kind == "set") {
        const std::size_t blank = rest.find(' ');
        if (!write_text(rest.substr(0, blank), rest.substr(blank + 1))) must(failed("set " + rest));
    } else {
        give_up("the manifest's word \"" + kind + "\" is unknown; add it to set_up of board/bench/init.cpp");
    }
}

[[noreturn]] void serve() {
    must(mount_kernel_files());
    ::setenv("PATH", "/bin:/usr/bin", 1);
    ::setenv("HOME", "/tmp", 1);
    // A command that dies in the middle must not take PID 1 with it.
    ::signal(SIGPIPE, SIG_IGN);

    const Manifest wanted = read_manifest(read_text("/bench/manifest"));
    must(load_modules(wanted.modules));
    console = open_port("tappet.console");
    results.open(open_port("tappet.results"));
    must(set_link("lo", true));
    for (const auto& [kind, rest] : wanted.devices) set_up(kind, rest);
    results.line("booted");
    say_to_host(start_of_output);

    int code = 0;
    for (const std::string& command : wanted.commands) {
        code = run(command);
        if (code != 0) break;
    }
    stop_background();
    for (const std::string& file : wanted.files) hand_over(file);
    results.line("exit " + std::to_string(code));

    // The host answers when it has read everything; only then may the power go.
    char answer = 0;
    if (say_to_host(end_of_output)) {
        while (::read(console, &answer, 1) < 0 && errno == EINTR) {
        }
    }
    power_off();
}

} // namespace
} // namespace tappet::bench

int main() { tappet::bench::serve(); }

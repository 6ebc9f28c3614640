// SPDX-License-Identifier: Apache-2.0
#include "toolchain/tools/bench/bench.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "toolchain/tools/bench/folders.hpp"
#include "toolchain/tools/bench/initramfs.hpp"

namespace tappet::bench {

namespace fs = std::filesystem;
using SteadyTime = std::chrono::steady_clock::time_point;

namespace {

// One instruction is 2^1 ns of guest time. A larger shift makes the box slower and the run longer.
constexpr int instruction_shift = 1;

// The guest's init sends these before the first command, and after all output.
constexpr char start_of_output = '\x1d';
constexpr char end_of_output = '\x1e';

double seconds_since(SteadyTime start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The box has the architecture for which its programs are built.
const Architecture& architecture_for(const Scenario& scenario) {
    std::vector<fs::path> files;
    for (const File& file : scenario.files) files.emplace_back(file.host);
    files.emplace_back(scenario.init);
    return architecture_of_first(files);
}

void pack(const Scenario& scenario, const Architecture& architecture, const fs::path& kernel,
          const fs::path& archive) {
    Initramfs root(archive, architecture);
    std::ostringstream manifest;

    std::ifstream modules(kernel / "modules.order");
    for (std::string module; std::getline(modules, module);) {
        root.add(kernel / "modules" / module, "/modules/" + module);
        manifest << "module /modules/" << module << '\n';
    }
    std::ifstream of_camera;
    if (scenario.camera) of_camera.open(kernel / "camera.order");
    for (std::string module; std::getline(of_camera, module);) {
        root.add(kernel / "modules" / module, "/modules/" + module);
        manifest << (module == "vivid.ko" ? "camera" : "module") << " /modules/" << module << '\n';
    }
    for (const std::string& name : scenario.can) manifest << "can " << name << '\n';
    for (const GpioChip& chip : scenario.gpio) manifest << "gpio " << chip.name << ' ' << chip.lines << '\n';
    if (scenario.unthrottled) manifest << "unthrottled\n";
    for (const Setting& setting : scenario.settings)
        manifest << "set " << setting.path << ' ' << setting.value << '\n';
    for (const std::string& command : scenario.commands) manifest << "run " << command << '\n';
    for (const File& file : scenario.collect) manifest << "collect " << file.guest << '\n';

    const fs::path init = scenario.init.empty() ? fs::canonical("/proc/self/exe").parent_path() /
                                                      ("bench-init" + architecture.suffix)
                                                : fs::path(scenario.init);
    if (!fs::exists(init)) {
        throw BenchError("the guest's PID 1 is not at '" + init.string() +
                         "'; build the target bench-init, or give --init");
    }
    root.add(init, "/init");
    for (const File& file : scenario.files) root.add(file.host, file.guest);
    for (const std::string& tool : scenario.tools) root.add_tool(tool);
    for (const char* folder : {"/proc", "/sys", "/tmp", "/run", "/bench"}) root.add_folder(folder);
    root.add_text("/bench/manifest", manifest.str());
    root.finish();
}

std::vector<std::string> emulator_arguments(const Scenario& scenario, const Architecture& architecture,
                                            const fs::path& kernel, const WorkFolder& work) {
    // The self-tests of the kernel's ciphers would take half of the boot time.
    std::string kernel_arguments =
        "console=" + architecture.console + " quiet panic=-1 rdinit=/init cryptomgr.notests";
    if (!scenario.kernel_arguments.empty()) kernel_arguments += " " + scenario.kernel_arguments;
    std::vector<std::string> arguments = {
        architecture.emulator, "-nodefaults", "-no-user-config", "-display", "none", "-no-reboot",
        // Emulation, even when the host could virtualise: the same on every host, and required by the
        // instruction clock.
        "-accel", "tcg", "-m", std::to_string(scenario.memory_mib), "-smp",
        std::to_string(scenario.processors), "-kernel", (kernel / "vmlinux").string(), "-initrd",
        (work / "root.cpio").string(), "-append", kernel_arguments,
        // The kernel's own messages go to a file, which is read only after a failure.
        "-serial", "file:" + (work / "kernel.log").string(), "-device", "virtio-serial-pci", "-chardev",
        "stdio,id=console,signal=off", "-device", "virtserialport,chardev=console,name=tappet.console",
        "-chardev", "file,id=results,path=" + (work / "results").string(), "-device",
        "virtserialport,chardev=results,name=tappet.results",
        // The watchdog sleeps until somebody opens it; its reset ends the guest.
        "-device", "i6300esb", "-machine"};
    arguments.insert(arguments.end(), architecture.machine.begin(), architecture.machine.end());
    for (std::size_t i = 0; i < scenario.can_cards.size(); ++i) {
        const std::string bus = "can-bus-" + std::to_string(i);
        arguments.insert(arguments.end(), {"-object", "can-bus,id=" + bus});
        if (scenario.can_cards[i] == "ctucan")
            arguments.insert(arguments.end(), {"-device", "ctucan_pci,canbus0=" + bus + ",canbus1=" + bus});
        else // Kvaser's cards, with one controller each
            for (int channel = 0; channel < 2; ++channel)
                arguments.insert(arguments.end(), {"-device", "kvaser_pci,canbus=" + bus});
    }
    if (scenario.clock == Clock::instructions) {
        arguments.insert(arguments.end(),
                         {"-icount", "shift=" + std::to_string(instruction_shift) + ",sleep=off"});
    }
    return arguments;
}

struct Emulator {
    pid_t pid = -1;
    int input = -1;  // to the guest's console
    int output = -1; // from it

    Emulator() = default;
    ~Emulator() {
        if (pid > 0) {
            ::kill(pid, SIGKILL);
            ::waitpid(pid, nullptr, 0);
        }
        close_pipes();
    }
    Emulator(const Emulator&) = delete;
    Emulator& operator=(const Emulator&) = delete;

    void close_pipes() {
        for (int* end : {&input, &output}) {
            if (*end >= 0) {
                ::close(*end);
                *end = -1;
            }
        }
    }

    void start(const std::vector<std::string>& arguments, const std::string& package, const fs::path& log) {
        int to[2];
        int from[2];
        if (::pipe2(to, O_CLOEXEC) != 0 || ::pipe2(from, O_CLOEXEC) != 0)
            throw BenchError("no pipe left on the host for the emulator");
        std::vector<char*> words;
        for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
        words.push_back(nullptr);
        const pid_t parent = ::getpid();
        pid = ::fork();
        if (pid == 0) {
            // The bench may be killed at any time; an emulator left behind would occupy a processor for ever.
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            if (::getppid() != parent) ::_exit(127);
            ::setpgid(0, 0); // the terminal's Ctrl-C is for the bench, which then ends the guest
            const int errors = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
            ::dup2(to[0], STDIN_FILENO);
            ::dup2(from[1], STDOUT_FILENO);
            ::dup2(errors, STDERR_FILENO);
            ::execvp(words[0], words.data());
            ::dprintf(STDERR_FILENO, "cannot run %s: %s; install the package %s\n", words[0],
                      std::strerror(errno), package.c_str());
            ::_exit(127);
        }
        ::close(to[0]);
        ::close(from[1]);
        input = to[1];
        output = from[0];
        if (pid < 0) throw BenchError("cannot start another process on the host");
    }
};

// Returns the last lines of the emulator's or the kernel's messages.
std::string tail_of(const fs::path& path) {
    std::ifstream file(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) {
        std::erase_if(line, [](char c) { return static_cast<unsigned char>(c) < ' '; });
        if (!line.empty()) lines.push_back(line);
    }
    std::string text;
    for (std::size_t i = lines.size() > 8 ? lines.size() - 8 : 0; i < lines.size(); ++i)
        text += "\n    " + lines[i];
    return text;
}

struct Report {
    bool booted = false;
    bool ended = false;
    int exit_code = -1;
    std::string running; // the command that had not ended
    std::string fault;
    std::vector<std::string> missing;
};

Report read_results(const fs::path& path, const std::vector<File>& wanted) {
    Report report;
    std::ifstream results(path, std::ios::binary);
    for (std::string line; std::getline(results, line);) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        const std::string rest = line.substr(std::min(line.size(), kind.size() + 1));
        if (kind == "booted") {
            report.booted = true;
        } else if (kind == "start") {
            report.running = rest;
        } else if (kind == "done") {
            report.running.clear();
        } else if (kind == "fault") {
            report.fault = rest;
        } else if (kind == "missing") {
            report.missing.push_back(rest);
        } else if (kind == "exit") {
            words >> report.exit_code;
            report.ended = true;
        } else if (kind == "file") {
            std::size_t size = 0;
            std::string name;
            words >> size;
            words.get();
            std::getline(words, name);
            std::string content(size, '\0');
            results.read(content.data(), static_cast<std::streamsize>(size));
            for (const File& file : wanted) {
                if (file.guest == name) {
                    std::ofstream target(file.host, std::ios::binary);
                    target << content;
                    if (!target.flush()) {
                        throw BenchError("cannot write '" + file.host +
                                         "', collected from the guest; check --collect");
                    }
                }
            }
        }
    }
    return report;
}

enum class End { complete, emulator_gone, timeout, cancelled };

// A guest that boots on a busy host is slow, which is not yet a fault.
constexpr double boot_limit_s = 300;

// Passes the guest's output on until the guest reports its end, then answers; the guest switches off upon the
// answer.
End stream(Emulator& emulator, SteadyTime start, double timeout_s, const Output& output,
           const Cancelled& cancelled, double& boot_wall_s) {
    std::array<char, 65536> piece{};
    for (;;) {
        if (cancelled && cancelled()) return End::cancelled;
        const double left = (boot_wall_s > 0 ? boot_wall_s + timeout_s : boot_limit_s) - seconds_since(start);
        if (left <= 0) return End::timeout;
        pollfd descriptor{emulator.output, POLLIN, 0};
        const double patience_s = cancelled ? 0.1 : 3600.0;
        const int ready = ::poll(&descriptor, 1, static_cast<int>(std::min(left, patience_s) * 1000) + 1);
        if (ready <= 0) continue;
        const ssize_t count = ::read(emulator.output, piece.data(), piece.size());
        if (count <= 0) return End::emulator_gone;
        std::string_view bytes(piece.data(), static_cast<std::size_t>(count));
        if (boot_wall_s <= 0 && bytes.front() == start_of_output) {
            boot_wall_s = seconds_since(start);
            bytes.remove_prefix(1);
        }
        const std::size_t end = bytes.find(end_of_output);
        if (!bytes.substr(0, end).empty()) output(bytes.substr(0, end));
        if (end != std::string_view::npos) {
            const char answer = '\n';
            return ::write(emulator.input, &answer, 1) == 1 ? End::complete : End::emulator_gone;
        }
    }
}

bool wait_for_end(Emulator& emulator, double seconds) {
    const auto start = std::chrono::steady_clock::now();
    while (seconds_since(start) < seconds) {
        if (::waitpid(emulator.pid, nullptr, WNOHANG) == emulator.pid) {
            emulator.pid = -1;
            return true;
        }
        ::usleep(5000);
    }
    return false;
}

void check(const Scenario& scenario, const Architecture& architecture, const fs::path& kernel) {
    if (!fs::exists(kernel / "vmlinux") || !fs::exists(kernel / "modules.order")) {
        throw BenchError("there is no kernel '" + scenario.kernel + "' for " + architecture.name + " at " +
                         kernel.string() + "; use rt (or rt-6.12 or plain, on x86-64), and run " +
                         architecture.set_up + " once as root");
    }
    for (const std::string& card : scenario.can_cards) {
        const fs::path driver = kernel / "modules" / (card == "ctucan" ? "ctucanfd.ko" : "kvaser_pci.ko");
        if (!fs::exists(driver)) {
            throw BenchError("there is no driver of the CAN card '" + card + "' at " + driver.string() +
                             "; run " + architecture.set_up + " once as root");
        }
    }
    if (scenario.camera && !fs::exists(kernel / "modules/vivid.ko")) {
        throw BenchError("there is no test camera at " + (kernel / "modules/vivid.ko").string() + "; run " +
                         architecture.set_up + " once as root");
    }
    if (scenario.clock == Clock::instructions && scenario.processors != 1) {
        throw BenchError("the instruction clock drives one processor only, " +
                         std::to_string(scenario.processors) +
                         " are asked for; use --cpus 1 or --clock host");
    }
    for (const std::string& command : scenario.commands) {
        if (command.find('\n') != std::string::npos) {
            throw BenchError("a command is one line; put '" + command.substr(0, command.find('\n')) +
                             "...' into a script and give it with --file");
        }
    }
}

Outcome run_checked(const Scenario& scenario, const Output& output, const Cancelled& cancelled) {
    const Architecture& architecture = architecture_for(scenario);
    const fs::path kernel = cache_folder() / "kernel" / (scenario.kernel + architecture.suffix);
    check(scenario, architecture, kernel);
    const WorkFolder work("tappet-bench", scenario.keep);
    pack(scenario, architecture, kernel, work / "root.cpio");

    const auto start = std::chrono::steady_clock::now();
    Emulator emulator;
    emulator.start(emulator_arguments(scenario, architecture, kernel, work), architecture.package,
                   work / "emulator.log");
    Outcome outcome;
    const End end = stream(emulator, start, scenario.timeout_s, output, cancelled, outcome.boot_wall_s);
    const bool stopped = end == End::complete ? wait_for_end(emulator, 10) : end == End::emulator_gone;
    outcome.total_wall_s = seconds_since(start);
    const Report report = read_results(work / "results", scenario.collect);
    outcome.exit_code = report.exit_code;
    if (end == End::cancelled) {
        outcome.cancelled = true;
        outcome.fault = "the run was cancelled";
    } else if (!report.fault.empty()) {
        outcome.fault = "the guest could not be set up: " + report.fault;
    } else if (end == End::timeout) {
        outcome.fault = "time-out after " +
                        std::to_string(static_cast<int>(report.booted ? scenario.timeout_s : boot_limit_s)) +
                        " s of wall time ";
        if (!report.booted) {
            outcome.fault +=
                "before the first command; the kernel's last words:" + tail_of(work / "kernel.log");
        } else if (report.running.empty()) {
            outcome.fault += "after the last command; raise --timeout";
        } else {
            outcome.fault += "in '" + report.running + "'; see why it does not end, or raise --timeout";
        }
    } else if (!report.ended) {
        const std::string words = tail_of(work / "emulator.log") + tail_of(work / "kernel.log");
        outcome.fault = "the guest ended by itself" +
                        (report.running.empty() ? std::string() : " in '" + report.running + "'") +
                        "; last words:" + (words.empty() ? " none" : words);
    } else if (!stopped) {
        outcome.fault = "the guest did not switch off; last words:" + tail_of(work / "kernel.log");
    } else if (!report.missing.empty() && report.exit_code == 0) {
        outcome.fault = "the guest has no file '" + report.missing.front() + "' to collect; check --collect";
    } else {
        outcome.completed = true;
    }
    return outcome;
}

} // namespace

void add_board(Scenario& scenario) {
    for (const char* bus : {"can0", "can1", "can2"}) scenario.can.emplace_back(bus);
    for (const char* chip : {"io", "panel"}) scenario.gpio.push_back({chip, 32});
    scenario.unthrottled = true;
}

Outcome run(const Scenario& scenario, const Output& output, const Cancelled& cancelled) {
    try {
        return run_checked(scenario, output, cancelled);
    } catch (const std::exception& error) {
        Outcome outcome;
        outcome.fault = error.what();
        return outcome;
    }
}

} // namespace tappet::bench

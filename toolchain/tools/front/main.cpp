// tappet: the front door. Writes a new machine's project, builds it, runs it, tests it, boots it on the bench
// and looks into it; each by a program that also stands for itself.
#include "toolchain/machine/host_options.hpp"
#include "toolchain/tools/front/project.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace tappet::front {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr int wrong_use = 2;

int fail(const std::string& why) {
    std::cerr << "tappet: " << why << "\n";
    return wrong_use;
}

/// Where this program lies, and with it the others.
fs::path beside_us() { return fs::read_symlink("/proc/self/exe").parent_path(); }

/// Installed at <prefix>/lib/tappet; else the tools of a clone's build tree.
bool is_installed() { return fs::exists(beside_us() / "../cmake/Tappet/TappetConfig.cmake"); }

int run(const Words& words) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        ::execvp(arguments[0], arguments.data());
        std::cerr << "tappet: cannot run " << words[0] << ": " << std::strerror(errno) << "\n";
        ::_exit(127);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int become(const Words& words) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    return fail("cannot run " + words[0] + ": " + std::strerror(errno));
}

Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// The project of this folder, configured and built: all of it, or these targets; "-" stands for the
/// machine's host program, "--bench" for <machine>-bench. Empty: why was said.
std::string built_machine(const Words& targets) {
    const auto machine = machine_of("CMakeLists.txt");
    if (!machine) {
        fail(machine.error());
        return {};
    }
    if (!fs::exists("build/build.ninja")) {
        Words configure{"cmake", "-S", ".", "-B", "build", "-G", "Ninja"};
        if (is_installed())
            configure.push_back("-DTappet_DIR=" + fs::canonical(beside_us() / "../cmake/Tappet").string());
        if (run(configure) != 0) return {};
    }
    Words build{"cmake", "--build", "build"};
    for (const std::string& target : targets)
        build = with(std::move(build), {"--target", target == "-"              ? *machine
                                                    : target.starts_with("--") ? *machine + target.substr(1)
                                                                               : target});
    return run(build) == 0 ? *machine : std::string{};
}

int make(const Words& words) {
    Choice choice;
    for (const std::string& word : words)
        if (word == "--can")
            choice.can = true;
        else if (word == "--modbus")
            choice.modbus = true;
        else if (word == "--gpio")
            continue; // every machine has its lines
        else if (word.starts_with("-") || !choice.name.empty())
            return fail("\"" + word + "\" is too much: tappet new NAME [--can] [--gpio] [--modbus]");
        else
            choice.name = word;
    const fs::path templates =
        is_installed() ? beside_us() / "../../share/tappet/template" : fs::path{TAPPET_TEMPLATE};
    if (const std::string fault = write_project(templates, choice); !fault.empty()) return fail(fault);
    std::cout << choice.name << "/ is written. Next: cd " << choice.name << ", then tappet run\n";
    return 0;
}

int build(const Words& words) { return built_machine(words).empty() ? 1 : 0; }

int run_host(const Words& words) {
    // Who asks what there is does not want to wait for a build.
    const auto named = machine_of("CMakeLists.txt");
    if (words == Words{"--help"} && named && !fs::exists("build/" + *named)) {
        std::cout << "the machine \"" << *named
                  << "\" with its plant in one process; its plant's own options are shown once it is built\n"
                  << usage_of(host_options);
        return 0;
    }
    const std::string machine = built_machine({"-"});
    return machine.empty() ? 1 : become(with({"build/" + machine}, words));
}

int test(const Words& words) {
    if (built_machine({}).empty()) return 1;
    return become(with({"ctest", "--test-dir", "build", "--output-on-failure"}, words));
}

int bench(const Words& words) {
    std::string seconds = "10";
    if (words.size() == 2 && words[0] == "--for")
        seconds = words[1];
    else if (!words.empty())
        return fail("bench takes --for SECONDS, of the box's own time");
    const std::string machine = built_machine({"--bench", "--plant"});
    if (machine.empty()) return 1;
    if (is_installed() && std::getenv("TAPPET_CACHE") == nullptr)
        ::setenv("TAPPET_CACHE", (beside_us() / "../../share/tappet/foreign").c_str(), 1);
    // All that the bench's board has: what the machine is not bound to lies idle.
    return become({(beside_us() / "tappet-bench").string(),
                   "--timeout",
                   "600",
                   "--file",
                   "build/" + machine + "-bench.stripped=/bin/firmware",
                   "--file",
                   "build/" + machine + "-plant=/bin/plant",
                   "--can",
                   "can0",
                   "--can",
                   "can1",
                   "--gpio-chip",
                   "io:32",
                   "--gpio-chip",
                   "panel:32",
                   "--set",
                   "/proc/sys/kernel/sched_rt_runtime_us=-1",
                   "--run",
                   "plant --fifo 1 &",
                   "--run",
                   "@sleep 0.3",
                   "--run",
                   "firmware --for " + seconds,
                   "--run",
                   "@signal plant TERM",
                   "--run",
                   "@wait plant"});
}

int browse(const Words& words) { return become(with({(beside_us() / "tappet-browse").string()}, words)); }
int scope(const Words& words) { return browse(with({"scope"}, words)); }

struct Command {
    const char* name;
    const char* usage;
    const char* help;
    int (*run)(const Words&);
};
constexpr Command commands[] = {
    {"new", "new NAME [--can] [--gpio] [--modbus]", "writes a machine's project into the folder NAME", &make},
    {"build", "build [TARGET...]", "builds the machine of this folder: host program, firmware, bench plant",
     &build},
    {"run", "run [OPTION...]", "runs machine and plant in one process; run --help lists its options",
     &run_host},
    {"test", "test [OPTION...]", "builds and runs the machine's tests; options are those of ctest", &test},
    {"bench", "bench [--for SECONDS]", "boots the firmware on an emulated box with a real-time kernel",
     &bench},
    {"browse", "browse [WORD...]", "looks into a running machine; browse help lists its words", &browse},
    {"scope", "scope [WORD...]", "which cycles of a running machine were the worst, and why", &scope},
};

int help() {
    std::cout << "tappet: machine controllers on real-time Linux\n";
    for (const Command& each : commands) std::printf("  tappet %-38s %s\n", each.usage, each.help);
    return 0;
}

} // namespace

int main(int count, char** words) {
    const Words all(words + 1, words + count);
    if (all.empty() || all[0] == "--help" || all[0] == "help") return help();
    for (const Command& each : commands) {
        if (all[0] != each.name) continue;
        const Words rest(all.begin() + 1, all.end());
        const bool own_help = each.run == &run_host || each.run == &browse || each.run == &scope;
        if (!own_help && rest.size() == 1 && rest[0] == "--help") {
            std::printf("tappet %s\n  %s\n", each.usage, each.help);
            return 0;
        }
        return each.run(rest);
    }
    Words names;
    for (const Command& each : commands) names.emplace_back(each.name);
    return fail("\"" + all[0] + "\" is no command" + suggestion(all[0], names) +
                "; tappet --help lists them");
}

} // namespace tappet::front

int main(int count, char** words) { return tappet::front::main(count, words); }

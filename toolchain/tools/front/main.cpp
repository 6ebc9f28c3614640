// tappet: the command line tool. It creates a new machine's project, builds, runs, tests, measures and draws
// it, boots it on the bench, writes and flashes its image, and browses it. Each command starts a program that
// also works by itself.
#include "toolchain/machine/host_options.hpp"
#include "toolchain/tools/chart/options.hpp"
#include "toolchain/tools/check/check.hpp"
#include "toolchain/tools/front/commands.hpp"
#include "toolchain/tools/front/figures.hpp"
#include "toolchain/tools/front/project.hpp"
#include "toolchain/tools/image/options.hpp"
#include "toolchain/version.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace tappet::front {
namespace {

namespace fs = std::filesystem;

constexpr int wrong_use = 2;

int fail(const std::string& why) {
    std::cerr << "tappet: " << why << "\n";
    return wrong_use;
}

/// Returns the folder of this program and the others.
fs::path beside_us() { return fs::read_symlink("/proc/self/exe").parent_path(); }

/// Returns true when installed at <prefix>/lib/tappet; otherwise these are the tools of a clone's build tree.
bool is_installed() { return fs::exists(beside_us() / "../cmake/Tappet/TappetConfig.cmake"); }

int become(const Words& words) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    std::cout.flush();
    ::execvp(arguments[0], arguments.data());
    return fail("cannot run " + words[0] + ": " + std::strerror(errno));
}

int run(const Words& words) {
    std::cout.flush();
    const pid_t child = ::fork();
    if (child == 0) {
        static_cast<void>(become(words));
        ::_exit(127);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// Returns the machine that --machine names, or the first of this folder. Empty: the reason was printed.
std::string machine_here(const Given& given) {
    const auto machines = machines_of("CMakeLists.txt");
    if (!machines) {
        fail(machines.error());
        return {};
    }
    const std::string wanted{given.line.text("--machine", machines->front())};
    if (std::ranges::find(*machines, wanted) != machines->end()) return wanted;
    const std::vector<std::string_view> names(machines->begin(), machines->end());
    fail("there is no machine \"" + wanted + "\" here" + did_you_mean(wanted, names));
    return {};
}

/// Configures and builds this folder's project, or these targets. False: the reason was printed.
bool is_built(const Words& targets) {
    if (!fs::exists("build/build.ninja")) {
        Words configure{"cmake", "-S", ".", "-B", "build", "-G", "Ninja"};
        if (is_installed())
            configure.push_back("-DTappet_DIR=" + fs::canonical(beside_us() / "../cmake/Tappet").string());
        if (run(configure) != 0) return false;
    }
    Words build{"cmake", "--build", "build"};
    for (const std::string& target : targets) build = with(std::move(build), {"--target", target});
    return run(build) == 0;
}

int make(const Given& given) {
    if (given.line.words.size() > 1)
        return fail("\"" + std::string{given.line.words[1]} + "\" is too much: a machine has one name");
    Choice choice{
        .can = given.line.has("--can"), .modbus = given.line.has("--modbus"), .cam = given.line.has("--cam")};
    if (!given.line.words.empty()) choice.name = given.line.words[0];
    const fs::path templates =
        is_installed() ? beside_us() / "../../share/tappet/template" : fs::path{TAPPET_TEMPLATE};
    if (const std::string fault = write_project(templates, choice); !fault.empty()) return fail(fault);
    std::cout << choice.name << "/ is written. Next: cd " << choice.name << ", then tappet run\n";
    return 0;
}

int build(const Given& given) {
    if (machine_here(given).empty()) return wrong_use;
    return is_built({given.line.words.begin(), given.line.words.end()}) ? 0 : 1;
}

int run_host(const Given& given) {
    const auto machines = machines_of("CMakeLists.txt");
    if (given.line.has("--help")) { // help must not wait for a build
        const std::string program = machines ? "build/" + machines->front() : "";
        if (fs::exists(program)) return become({program, "--help"});
        std::cout << "tappet run: a machine with its plant in one process; the plant's own options are shown "
                     "once it is built\n"
                  << usage_of(host_options);
        return 0;
    }
    const std::string machine = machine_here(given);
    if (machine.empty()) return wrong_use;
    Words program{"build/" + machine};
    for (const auto& [option, value] : given.line.of_others) {
        if (!has_option(".", option)) {
            std::vector<std::string_view> names;
            for (const Option& each : host_options) names.push_back(each.name);
            return fail(
                "run: option " + std::string{option} + " is unknown, and no source file here names it" +
                did_you_mean(option, names, "; see --help;") + " words after -- go to the machine unchecked");
        }
        program = with(program, {std::string{option}, std::string{value}});
    }
    for (const auto& [option, value] : given.line.options)
        if (option->name != "--machine") {
            program.emplace_back(option->name);
            if (!option->value.empty()) program.emplace_back(value);
        }
    return is_built({machine}) ? become(with(program, given.behind)) : 1;
}

int test(const Given& given) {
    if (machine_here(given).empty()) return wrong_use;
    Words ctest{"ctest", "--test-dir", "build", "--output-on-failure"};
    if (given.line.has("--only")) ctest = with(ctest, {"-R", std::string{given.line.text("--only")}});
    return is_built({}) ? become(with(ctest, given.behind)) : 1;
}

/// Uses the kernels and foreign sources of the package, unless the environment names others.
void use_what_is_installed() {
    if (is_installed()) ::setenv("TAPPET_CACHE", (beside_us() / "../../share/tappet/foreign").c_str(), 0);
}

int bench(const Given& given) {
    const std::string machine = machine_here(given);
    if (machine.empty()) return wrong_use;
    if (!is_built({machine + "-bench", machine + "-plant"})) return 1;
    use_what_is_installed();
    return become({(beside_us() / "tappet-bench").string(),
                   "--board", // devices that the machine is not bound to stay idle
                   "--timeout", "600", "--file", "build/" + machine + "-bench.stripped=/bin/firmware",
                   "--file", "build/" + machine + "-plant=/bin/plant", "--run", "plant &", "--run",
                   "@sleep 0.3", "--run", "firmware --for " + std::string{given.line.text("--for", "10")},
                   "--run", "@signal plant TERM", "--run", "@wait plant"});
}

/// Writes the image; for the bench's board with the plant, because nothing else is at its wires.
int image(const Given& given) {
    const std::string machine = machine_here(given);
    if (machine.empty()) return wrong_use;
    if (given.line.words.size() != 1) return fail("image: name one board: tappet image my_box");
    const std::string board{given.line.words[0]};
    const std::vector<std::string> boards = boards_of("CMakeLists.txt", machine);
    if (board == "host" || std::ranges::find(boards, board) == boards.end()) {
        const std::vector<std::string_view> names(boards.begin(), boards.end());
        return fail("image: " + machine + " has no firmware for board \"" + board + "\"" +
                    did_you_mean(board, names, "; add it to BOARDS in CMakeLists.txt"));
    }
    const std::string firmware = machine + "-" + board;
    Words targets{firmware};
    Words program{(beside_us() / "tappet-image").string(), "write", "--firmware",
                  "build/" + firmware + ".stripped",       "--to",  "build/image/" + firmware};
    if (board == "bench") {
        targets.push_back(machine + "-plant");
        program = with(program, {"--plant", "build/" + machine + "-plant"});
    }
    for (const auto& [option, value] : given.line.options)
        if (option->name != "--machine")
            program = with(program, {std::string{option->name}, std::string{value}});
    use_what_is_installed();
    return is_built(targets) ? become(program) : 1;
}

template <const char* word>
int hand_to_image(const Given& given) {
    return become(with({(beside_us() / "tappet-image").string(), word}, given.words));
}
constexpr char flash_word[] = "flash", update_word[] = "update", box_word[] = "box";

int chart(const Given& given) {
    const std::string machine = machine_here(given);
    if (machine.empty()) return wrong_use;
    if (!is_built({machine + "-chart"})) return 1;
    Words program{"build/" + machine + "-chart", "--to",
                  std::string{given.line.text("--to", "build/charts")}};
    for (const std::string_view word : given.line.words) program.emplace_back(word);
    return become(program);
}

int wires(const Given& given) {
    const std::string machine = machine_here(given);
    if (machine.empty()) return wrong_use;
    return is_built({machine}) ? become({"build/" + machine, "--wires"}) : 1;
}

/// Shows the figures; in a clone, those of the framework.
int figures(const Given& given) {
    if (fs::exists("ci/figures")) return become(with({"ci/figures"}, given.words));
    const std::string machine = machine_here(given);
    if (machine.empty()) return wrong_use;
    if (!is_built({machine})) return 1;
    const std::string summary = "build/figures.json";
    const int ending = run({"build/" + machine, "--real", "--quiet", "--summary", summary, "--for",
                            std::string{given.line.text("--for", "10")}});
    if (ending != 0 && ending != 1) return ending; // 1: the plant wanted a longer run; the figures are valid
    std::ifstream file{summary};
    const auto text = figures_of({std::istreambuf_iterator<char>{file}, {}});
    if (!text) return fail(text.error());
    std::cout << *text << "all of it is in " << summary << "\n";
    return 0;
}

int check_files(const Given& given) {
    const checking::Report report = checking::report_on({given.line.words.begin(), given.line.words.end()},
                                                        std::string{given.line.text("--node")});
    if (!report.failure.empty()) return fail("check: " + report.failure);
    std::cout << report.text;
    return report.has_faults ? 1 : 0;
}

int browse(const Given& given) {
    return become(with({(beside_us() / "tappet-browse").string()}, given.words));
}
int scope(const Given& given) {
    return become(with({(beside_us() / "tappet-browse").string(), "scope"}, given.words));
}

constexpr Option machine_option{"--machine", "NAME", "one of several in this folder (default: the first)"};
constexpr Option time_option{.name = "--for",
                             .value = "SECONDS",
                             .help = "how long (default 10)",
                             .is_number = true,
                             .least = 1,
                             .most = 86'400};

template <std::size_t n>
constexpr std::array<Option, n + 1> for_a_machine(const std::array<Option, n>& options) {
    std::array<Option, n + 1> all{machine_option};
    std::ranges::copy(options, all.begin() + 1);
    return all;
}
constexpr std::array machine_options{machine_option};
constexpr std::array new_options{Option{"--can", "", "a drive on a CAN bus"},
                                 Option{"--gpio", "", "digital lines, in every machine"},
                                 Option{"--modbus", "", "a unit behind Modbus TCP"},
                                 Option{"--cam", "", "a shaft with its encoder on CAN, and a cam"}};
constexpr auto run_options = for_a_machine(host_options);
constexpr std::array test_options{Option{"--only", "REGEX", "tests whose names match"}};
constexpr std::array check_options{
    Option{"--node", "NAME", "the machine's node: faults that affect only others are notes"}};
constexpr auto timed_options = for_a_machine(std::array{time_option});
constexpr auto box_image_options = for_a_machine(image::image_options);
constexpr auto chart_options = for_a_machine(chart::chart_options);

constexpr Command commands[] = {
    {.name = "new",
     .takes = "NAME",
     .help = "writes a machine's project into the folder NAME",
     .options = new_options,
     .others = Others::words,
     .run = &make},
    {.name = "build",
     .takes = "[TARGET...]",
     .help = "builds the machine of this folder: host program, firmware, bench plant",
     .others = Others::words,
     .run = &build},
    {.name = "run",
     .takes = "",
     .help = "runs machine and plant in one process",
     .options = run_options,
     .others = Others::options,
     .run = &run_host},
    {.name = "test",
     .takes = "[-- OPTION...]",
     .help = "builds and runs the machine's tests; words after -- go to ctest",
     .options = test_options,
     .run = &test},
    {.name = "chart",
     .takes = "[WHAT...]",
     .help = "draws the machine's table and behaviours into build/charts",
     .options = chart_options,
     .others = Others::words,
     .kinds = chart::chart_words,
     .run = &chart},
    {.name = "wires",
     .takes = "",
     .help = "prints a value of each CAN signal and Modbus register with its bytes on the wire",
     .options = machine_options,
     .run = &wires},
    {.name = "check",
     .takes = "FILE...",
     .help = "lists all that is wrong in DBC, EDS and DCF files or their folders, and who is affected",
     .options = check_options,
     .others = Others::words,
     .run = &check_files},
    {.name = "figures",
     .takes = "",
     .help =
         "measures each activity's times on this host in real time; in a clone of Tappet: runs ci/figures",
     .options = timed_options,
     .run = &figures},
    {.name = "bench",
     .takes = "",
     .help = "runs the firmware on an emulated box with a real-time kernel; --for counts the box's own time",
     .options = timed_options,
     .run = &bench},
    {.name = "image",
     .takes = "BOARD",
     .help = "writes the disk image of a box into build/image",
     .options = box_image_options,
     .others = Others::words,
     .run = &image},
    {.name = "flash",
     .takes = "DEVICE",
     .help = "writes an image onto a disk, and reads it back",
     .options = image::flash_options,
     .others = Others::words,
     .run = &hand_to_image<flash_word>},
    {.name = "update",
     .takes = "BOX FILE",
     .help = "sends a signed new version to a box; a person there must consent",
     .others = Others::words,
     .run = &hand_to_image<update_word>},
    {.name = "box",
     .takes = "BOX [ORDER]",
     .help = "shows what runs on a box, or sends an order: roll-back, factory-reset, measure",
     .options = image::box_options,
     .others = Others::words,
     .run = &hand_to_image<box_word>},
    {.name = "browse",
     .takes = "[WORD...]",
     .help = "looks into a running machine",
     .passes_on = true,
     .run = &browse},
    {.name = "scope",
     .takes = "[WORD...]",
     .help = "shows the worst cycles of a running machine, and why",
     .passes_on = true,
     .run = &scope},
};

std::string usage_line(const Command& command, std::size_t column) {
    std::string text = "tappet " + std::string{command.name};
    if (!command.options.empty()) text += " [OPTION...]";
    if (!command.takes.empty()) text += " " + std::string{command.takes};
    if (text.size() < column) text.resize(column, ' ');
    return text + "  " + std::string{command.help} + "\n";
}

int help() {
    std::cout << "tappet: machine controllers on real-time Linux; --help after a command lists its options\n";
    for (const Command& each : commands) std::cout << "  " << usage_line(each, 36);
    return 0;
}

/// Returns the command to which a word's option belongs, if not to this one. A plant may have any option.
std::string owner_of(const Command& command, const Words& words) {
    for (const std::string& word : words)
        for (const Command& each : commands) {
            const auto has = [&](const Command& of) {
                return std::ranges::find(of.options, word, &Option::name) != of.options.end();
            };
            const bool is_plants = command.others == Others::options && has_option(".", word);
            if (!has(command) && has(each) && !is_plants)
                return "option " + word + " belongs to tappet " + std::string{each.name} +
                       ", not to tappet " + std::string{command.name};
        }
    return {};
}

int obey(const Command& command, Words words) {
    Given given;
    if (!command.passes_on && !(command.run == &figures && fs::exists("ci/figures"))) {
        if (const auto end = std::ranges::find(words, "--"); end != words.end()) {
            given.behind.assign(end + 1, words.end());
            words.erase(end, words.end());
        }
        given.words = std::move(words);
        const bool asks = std::ranges::find(given.words, "--help") != given.words.end();
        if (asks && command.run != &run_host) {
            std::cout << usage_line(command, 0) << usage_of(command.options) << usage_of(command.kinds);
            return 0;
        }
        const std::vector<std::string_view> views(given.words.begin(), given.words.end());
        auto line = read_command_line(command.options, views, command.others, command.kinds);
        if (std::string owner = owner_of(command, given.words); !owner.empty()) return fail(owner);
        if (!line) return fail(std::string{command.name} + ": " + line.error());
        given.line = std::move(*line);
    } else {
        given.words = std::move(words);
    }
    return command.run(given);
}

} // namespace

int main(int count, char** words) {
    if (prints_version(count, words, "tappet")) return 0;
    const Words all(words + 1, words + count);
    if (all.empty() || all[0] == "--help" || all[0] == "help") return help();
    if (all[0] == "--complete") {
        for (const std::string& each : completions(commands, {all.begin() + 1, all.end()}))
            std::cout << each << "\n";
        return 0;
    }
    const auto command = std::ranges::find(commands, all[0], &Command::name);
    if (command != std::end(commands)) return obey(*command, {all.begin() + 1, all.end()});
    std::vector<std::string_view> names;
    for (const Command& each : commands) names.push_back(each.name);
    return fail("\"" + all[0] + "\" is not a command" + did_you_mean(all[0], names) +
                "; tappet --help lists them");
}

} // namespace tappet::front

int main(int count, char** words) { return tappet::front::main(count, words); }

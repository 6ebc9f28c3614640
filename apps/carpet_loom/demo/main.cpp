// carpet-loom-demo: boots the bench with the firmware and the plant, shows the running loom, and sums the run
// up.
#include "apps/carpet_loom/demo/scenario.hpp"
#include "apps/carpet_loom/demo/verdict.hpp"
#include "apps/carpet_loom/demo/view.hpp"
#include "toolchain/tools/bench/folders.hpp"
#include "toolchain/version.hpp"

#include <csignal>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace tappet::demo {
namespace {

enum Ending : int {
    all_well = 0,
    found_faulty = 1,
    wrong_command_line = 2,
    did_not_end = 3,
    interrupted = 130
};

/// A loom that has woven nothing for this long, in its own time, will not resume.
constexpr std::int64_t most_idle_ms = 60'000;
/// Longest silence before the run is aborted. The loom prints four lines in each second of its own time; even
/// a loaded host is faster than this.
constexpr std::chrono::seconds most_silence{120};

volatile std::sig_atomic_t told_to_end = 0;

std::string contents_of(const std::filesystem::path& path) {
    std::ifstream file{path, std::ios::binary};
    std::ostringstream text;
    text << file.rdbuf();
    return std::move(text).str();
}

/// Prints all messages of the guest except its status lines, because one of them states the reason.
int complain(const Story& story, bool already_shown, const std::string& what) {
    if (!already_shown)
        for (const std::string& message : story.messages()) std::fprintf(stdout, "  %s\n", message.c_str());
    std::printf("the run did not finish: %s\n", what.c_str());
    return did_not_end;
}

std::string meaning_of(int exit_code) {
    switch (exit_code) {
    case 2: return "a wrong set-up: a device, a file or an option";
    case 3: return "the firmware refused to arm; its reasons with their cures are above";
    case 4: return "a fault stopped the machine";
    case 127: return "a program is missing in the guest";
    default:
        return exit_code > 128 ? "a program died of signal " + std::to_string(exit_code - 128) : "see above";
    }
}

int sum_up(const Verdict& verdict, const std::string& file) {
    std::printf("\n%s\n", verdict.table.c_str());
    for (const std::string& fault : verdict.faults) std::printf("  fault: %s\n", fault.c_str());
    std::printf("the whole summary is in %s\n", file.c_str());
    return verdict.faults.empty() ? all_well : found_faulty;
}

/// Returns why the run cannot be summed up; empty when it can.
std::string fault_of(const bench::Outcome& outcome, const Story& story, bool is_silent) {
    if (outcome.cancelled && is_silent)
        return "the box has said nothing for " + std::to_string(most_silence.count()) +
               " s; a real-time thread that never sleeps would do that";
    if (outcome.cancelled)
        return "the loom wove nothing for " + std::to_string(most_idle_ms / 1000) +
               " s of its own time; state " + std::string{text_of(story.status(), "state")} + ", cause " +
               std::string{text_of(story.status(), "cause")};
    if (!outcome.completed) return outcome.fault;
    if (outcome.exit_code == 0) return {};
    return "exit code " + std::to_string(outcome.exit_code) +
           " in the guest: " + meaning_of(outcome.exit_code);
}

int weave(const CommandLine& options) {
    const bench::WorkFolder folder{"carpet-loom-demo"};
    const std::uint64_t picks = options.number("--picks", usual_picks);
    bench::Scenario scenario = scenario_of(options);
    scenario.collect = {{folder / "machine.json", machine_report}, {folder / "plant.json", plant_report}};
    Story story;
    Lines lines;
    View view{options.has("--plain"), static_cast<std::int64_t>(picks)};
    const bool is_plain = !view.draws();

    using Steady = std::chrono::steady_clock;
    auto heard = Steady::now();
    const auto silent = [&] { return Steady::now() - heard > most_silence; };
    const auto hear = [&](std::string_view bytes) {
        heard = Steady::now();
        lines.add(bytes, [&](std::string_view line) { view.show(story, story.take(line)); });
    };
    const auto cancelled = [&] {
        view.tick(story);
        return told_to_end != 0 || story.idle_ms() > most_idle_ms || silent();
    };
    const bench::Outcome outcome = bench::run(scenario, hear, cancelled);
    const bool is_silent = silent();
    view.finish();

    if (told_to_end != 0) {
        std::puts("interrupted: the bench is switched off");
        return interrupted;
    }
    if (const std::string fault = fault_of(outcome, story, is_silent); !fault.empty())
        return complain(story, is_plain, fault);
    const auto verdict = judge(contents_of(folder / "machine.json"), contents_of(folder / "plant.json"),
                               static_cast<std::int64_t>(picks));
    if (!verdict) return complain(story, is_plain, verdict.error());
    const std::string file{options.text("--summary")};
    if (!(std::ofstream{file, std::ios::binary} << verdict->summary).flush())
        return complain(story, is_plain,
                        "the summary cannot be written to '" + file + "'; check the folder and its rights");
    return sum_up(*verdict, file);
}

} // namespace

int main(int count, const char* const* arguments) {
    if (prints_version(count, arguments, "carpet-loom-demo")) return all_well;
    const std::vector<std::string_view> words(arguments + 1, arguments + count);
    const auto options = read_options(words);
    if (!options) {
        std::fprintf(stderr, "carpet-loom-demo: %s\n", options.error().c_str());
        return wrong_command_line;
    }
    if (options->has("--help")) {
        std::fputs(usage().c_str(), stdout);
        return all_well;
    }
    struct sigaction action{};
    action.sa_handler = [](int) { told_to_end = 1; };
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
    return weave(*options);
}

} // namespace tappet::demo

int main(int count, char** words) { return tappet::demo::main(count, words); }

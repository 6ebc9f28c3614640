// carpet-loom-demo: boots the bench with the firmware and the plant, shows what the loom does, and sums it
// up.
#include "apps/carpet_loom/demo/merge.hpp"
#include "apps/carpet_loom/demo/options.hpp"
#include "apps/carpet_loom/demo/story.hpp"
#include "apps/carpet_loom/demo/terminal.hpp"
#include "apps/carpet_loom/demo/troubles.hpp"
#include "apps/carpet_loom/demo/verdict.hpp"
#include "toolchain/tools/bench/bench.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <unistd.h>

namespace tappet::demo {
namespace {

enum Ending : int {
    all_well = 0,
    found_faulty = 1,
    wrong_command_line = 2,
    did_not_end = 3,
    interrupted = 130
};

/// A loom that weaves nothing for so long of its own time will not go on by itself.
constexpr std::int64_t most_idle_ms = 60'000;
/// The loom says something four times in each second of its own; even a host with a lot to do is not that
/// slow.
constexpr std::chrono::seconds most_silence{120};

constexpr const char* machine_report = "/tmp/machine.json";
constexpr const char* plant_report = "/tmp/plant.json";

volatile std::sig_atomic_t told_to_end = 0;

class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "carpet-loom-demo-XXXXXX").string();
        if (::mkdtemp(pattern.data()) != nullptr) path_ = pattern;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] bool exists() const { return !path_.empty(); }
    [[nodiscard]] std::string file(const char* name) const { return path_ + "/" + name; }

private:
    std::string path_;
};

std::string contents_of(const std::string& path) {
    std::ifstream file{path, std::ios::binary};
    std::ostringstream text;
    text << file.rdbuf();
    return std::move(text).str();
}

/// A new weave takes over at a shaft angle; a faulty one is refused with its line; one that misbehaves is
/// taken back. The loom weaves on through all of it.
std::vector<std::string> change_of_weaves() {
    const auto load = [](const std::string& script, const std::string& moment) {
        return "tappet-browse behaviour load /weaves/" + script + " weft --at " + moment;
    };
    return {"@sleep 6",
            load(new_weave, "180"),
            "@sleep 2",
            "- " + load("faulty_twill.osd", "180"),
            load("running_out.osd", "shaft.beat_up"),
            "@sleep 3",
            "tappet-browse behaviour list",
            "@signal carpet-loom-plant USR1"};
}

bench::Scenario scenario_of(const Options& options, const TemporaryFolder& folder) {
    std::string plant = "carpet-loom-plant --seed " + std::to_string(options.seed) + " --picks " +
                        std::to_string(options.picks);
    for (const std::string& word : troubles(options.picks)) plant += " " + word;
    bench::Scenario scenario;
    scenario.init = options.init;
    scenario.files = {{options.firmware, "/bin/carpet_loom"},
                      {options.plant, "/bin/carpet-loom-plant"},
                      {options.browser, "/bin/tappet-browse"},
                      {options.behaviours, "/weaves"}};
    bench::add_board(scenario);
    // How long the requests of a browser take is the host's affair: the plant weaves on until they are
    // through, and some picks more.
    const bool changes_weaves = options.picks >= least_picks_for_weaves;
    scenario.commands = {
        plant + (changes_weaves ? " --picks-after-usr1 20" : "") + " --report " + plant_report + " &",
        "@sleep 1",
        std::string{"carpet_loom --summary "} + machine_report + " &",
    };
    if (changes_weaves) {
        const std::vector<std::string> weaves = change_of_weaves();
        scenario.commands.insert(scenario.commands.end(), weaves.begin(), weaves.end());
    }
    const std::vector<std::string> rest{
        "@wait carpet-loom-plant while carpet_loom",
        "@signal carpet_loom TERM",
        "@wait carpet_loom",
    };
    scenario.commands.insert(scenario.commands.end(), rest.begin(), rest.end());
    scenario.collect = {{folder.file("machine.json"), machine_report},
                        {folder.file("plant.json"), plant_report}};
    scenario.timeout_s =
        180.0 + 6.0 * static_cast<double>(options.picks); // a host ten times slower than ours
    return scenario;
}

void print_fault(const std::string& text) {
    std::fprintf(stdout, "%s\n", ::isatty(STDOUT_FILENO) != 0 ? red(text).c_str() : text.c_str());
}

/// Everything the guest said beside its status, since the reason is somewhere in it.
int complain(const Story& story, bool already_shown, const std::string& what) {
    if (!already_shown)
        for (const std::string& message : story.messages()) std::fprintf(stdout, "  %s\n", message.c_str());
    print_fault("the run did not come to its end: " + what);
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

int sum_up(const Options& options, const TemporaryFolder& folder, const Story& story, bool already_shown) {
    const auto merged =
        merge(contents_of(folder.file("machine.json")), contents_of(folder.file("plant.json")));
    if (!merged) return complain(story, already_shown, merged.error());
    {
        std::ofstream file{options.summary, std::ios::binary};
        file << *merged;
        if (!file.flush())
            return complain(story, already_shown,
                            "the summary cannot be written to '" + options.summary +
                                "'; check the folder and its rights");
    }
    const Verdict verdict = judge(*merged, options.picks);
    std::fprintf(stdout, "\n%s\n", verdict.table.c_str());
    for (const std::string& fault : verdict.faults) print_fault("  fault: " + fault);
    std::fprintf(stdout, "the whole summary is in %s\n", options.summary.c_str());
    return verdict.faults.empty() ? all_well : found_faulty;
}

int weave(const Options& options) {
    const TemporaryFolder folder;
    if (!folder.exists()) {
        print_fault("cannot make a temporary folder; check TMPDIR and its rights");
        return did_not_end;
    }
    Story story;
    Lines lines;
    Terminal terminal{options.plain};
    const bool plain = !terminal.draws();
    const auto begin = std::chrono::steady_clock::now();
    const auto frame = [&] {
        return Frame{options.picks,
                     std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
    };
    if (plain) std::puts("booting the emulated box");
    std::fflush(stdout);

    auto heard = begin;
    const auto silent = [&] { return std::chrono::steady_clock::now() - heard > most_silence; };
    const auto hear = [&](std::string_view bytes) {
        heard = std::chrono::steady_clock::now();
        lines.add(bytes, [&](std::string_view line) {
            const Story::Kind news = story.take(line);
            terminal.show(story, frame(), news);
        });
    };
    const auto cancelled = [&] {
        terminal.tick(story, frame());
        return told_to_end != 0 || story.idle_ms() > most_idle_ms || silent();
    };
    const bench::Outcome outcome = bench::run(scenario_of(options, folder), hear, cancelled);
    terminal.finish();

    if (told_to_end != 0) {
        std::puts("interrupted: the bench is switched off");
        return interrupted;
    }
    if (outcome.cancelled && silent())
        return complain(story, plain,
                        "the box has said nothing for " + std::to_string(most_silence.count()) +
                            " s; a real-time thread that never sleeps would do that");
    if (outcome.cancelled)
        return complain(story, plain,
                        "the loom wove nothing for " + std::to_string(most_idle_ms / 1000) +
                            " s of its own time; state " + story.status().state + ", cause " +
                            story.status().cause);
    if (!outcome.completed) return complain(story, plain, outcome.fault);
    if (outcome.exit_code != 0)
        return complain(story, plain,
                        "exit code " + std::to_string(outcome.exit_code) +
                            " in the guest: " + meaning_of(outcome.exit_code));
    return sum_up(options, folder, story, plain);
}

} // namespace

int main(int count, const char* const* words) {
    const auto options = parse_options(count, words);
    if (!options) {
        std::fprintf(stderr, "carpet-loom-demo: %s\n", options.error().c_str());
        return wrong_command_line;
    }
    if (options->help) {
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

// The host's program of a machine, from its command line to its exit code.
#include "toolchain/machine/host.hpp"

#include "kernel/base/nearest.hpp"
#include "kernel/machine/plan_text.hpp"
#include "kernel/os/box.hpp"
#include "kernel/os/terminal.hpp"
#include "kernel/services/json.hpp"
#include "toolchain/machine/host_usage.hpp"
#include "toolchain/machine/summary.hpp"

#include <charconv>
#include <cstdio>
#include <string>

namespace tappet {

namespace {

constexpr std::uint64_t most_seconds = 1'000'000'000; // some thirty years

enum Ending : int { ended_well = 0, ended_otherwise = 1, wrong_set_up = 2 };

struct Options {
    bool virtual_time = true;
    std::uint64_t seed = 1;
    std::uint64_t seconds = 0; ///< 0: as long as the plant usually takes
    std::string_view summary, properties, browse;
    bool quiet = false;
    bool plan = false;
    bool help = false;
    std::vector<std::pair<std::string_view, std::string_view>> of_plant{};
};

std::expected<std::uint64_t, Sentence> whole_number(std::string_view option, std::string_view word) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size())
        return std::unexpected(Sentence{"option ", option, ": \"", word,
                                        "\" is not a whole number; write for example ", option, " 60"});
    return value;
}

Sentence unknown(std::string_view option) {
    Nearest nearest{option};
    for (const std::string_view each : {"--virtual", "--real", "--seed", "--for", "--summary", "--properties",
                                        "--browse", "--quiet", "--plan", "--help"})
        nearest.consider(each);
    Sentence text{"option ", option, " is unknown"};
    text.add(nearest.best().empty() ? "; see --help" : "; did you mean ").add(nearest.best());
    if (!nearest.best().empty()) text.add("?");
    return text;
}

/// What is neither of these goes to the plant.
std::expected<Options, Sentence> parse(int count, char** words) {
    Options options;
    for (int i = 1; i < count; ++i) {
        const std::string_view option = words[i];
        if (option == "--virtual" || option == "--real") {
            options.virtual_time = option == "--virtual";
            continue;
        }
        if (option == "--quiet") {
            options.quiet = true;
            continue;
        }
        if (option == "--help" || option == "--plan") {
            (option == "--help" ? options.help : options.plan) = true;
            continue;
        }
        const bool is_ours = option == "--summary" || option == "--properties" || option == "--browse" ||
                             option == "--seed" || option == "--for";
        if (i + 1 == count)
            return std::unexpected(is_ours
                                       ? Sentence{"option ", option, " needs a value after it; see --help"}
                                       : unknown(option));
        const std::string_view word = words[++i];
        if (option == "--summary")
            options.summary = word;
        else if (option == "--properties")
            options.properties = word;
        else if (option == "--browse")
            options.browse = word;
        else if (option == "--seed" || option == "--for") {
            const auto value = whole_number(option, word);
            if (!value) return std::unexpected(value.error());
            (option == "--seed" ? options.seed : options.seconds) = *value;
            if (option == "--for" && (*value == 0 || *value > most_seconds))
                return std::unexpected(
                    Sentence{"option --for: a run takes 1 s at least, and ", most_seconds, " at most"});
        } else {
            options.of_plant.emplace_back(option, word);
        }
    }
    return options;
}

struct Outcome {
    Sentence reason{};
    bool well = false;
    std::uint64_t page_faults = 0;
    std::uint64_t contracts_broken = 0;
};

class Host {
public:
    Host(const AcceptedMachine& machine, Plant& plant, const Options& options)
        : machine_{machine}, name_{machine.table.name}, plant_{plant}, options_{options} {}

    int fail(const Sentence& why) const {
        static_cast<void>(os::write_all(2, Sentence{name_, ": ", why, "\n"}.view()));
        return wrong_set_up;
    }
    int run() {
        for (const auto& [option, value] : options_.of_plant) {
            Sentence fault;
            if (!plant_.take_option(option, value, fault)) return fail(unknown(option));
            if (!fault.empty()) return fail(Sentence{"option ", option, ": ", fault});
        }
        return options_.virtual_time ? run_virtual() : run_real();
    }

private:
    template <class Run>
    void prepare(Run& run) {
        run.keep_properties_in(options_.properties);
        run.instance().browse_in(options_.browse);
    }

    [[nodiscard]] Duration time() const {
        return options_.seconds == 0 ? plant_.usual_time() : std::chrono::seconds{options_.seconds};
    }

    int run_virtual() {
        VirtualRun run{machine_, plant_, options_.seed};
        prepare(run);
        if (const auto started = run.start(); !started) return fail(started.error());
        const Time end = run.now() + time();
        bool runs = true;
        while (runs && !plant_.is_done() && run.now() < end) runs = run.run_for(50ms);
        run.stop();
        Outcome outcome;
        judge(run.instance(), runs, outcome);
        return finish(run.instance(), run.devices(), outcome);
    }

    int run_real() {
        RealRun run{machine_, plant_, options_.seed};
        prepare(run);
        if (const auto started = run.start(2); !started) return fail(started.error());
        bool runs = true;
        for (Duration left = time(); runs && !run.is_done() && left > Duration::zero(); left -= 50ms)
            runs = run.supervise(50ms);
        const int hung = run.stop();
        Outcome outcome;
        judge(run.instance(), runs, outcome);
        outcome.page_faults = run.world().page_faults_in_real_time_threads();
        outcome.contracts_broken = run.world().breaches();
        if (outcome.contracts_broken != 0) outcome.reason = run.world().broken_contract();
        outcome.well &= hung == 0 && outcome.contracts_broken == 0;
        return finish(run.instance(), run.devices(), outcome);
    }

    /// Well: the plant is done, the time is over, or somebody asked it to end.
    void judge(const MachineInstance& instance, bool runs, Outcome& outcome) const {
        const Sentence fault = plant_.fault();
        outcome.well = fault.empty() && (runs || instance.stop_request().reason == StopReason::requested);
        outcome.reason = !runs              ? instance.describe_stop()
                         : !fault.empty()   ? fault
                         : plant_.is_done() ? Sentence{"the plant is done"}
                                            : Sentence{"its time is over"};
    }

    int finish(MachineInstance& instance, const SimulatedDevices& devices, const Outcome& outcome) {
        os::print(Sentence{name_, ": stopped: ", outcome.reason, "\n"}.view());
        tell_overruns(instance, name_);
        if (!options_.properties.empty())
            if (const Sentence fault = instance.save_properties(instance.standing()); !fault.empty())
                return fail(fault);
        std::string text(256 * 1024, '\0');
        const std::size_t length = write(instance, devices, outcome, text);
        if (length == 0) return fail(Sentence{"the summary does not fit its buffer"});
        const std::string path{options_.summary};
        if (!path.empty() && !os::replace_file(path.c_str(), {text.data(), length}))
            return fail(Sentence{"the summary cannot be written to \"", options_.summary,
                                 "\"; name a file in a folder that exists"});
        return outcome.well ? ended_well : ended_otherwise;
    }

    /// The machine's object, and what the plant measured as one of its fields; that is printed, too.
    std::size_t write(MachineInstance& instance, const SimulatedDevices& devices, const Outcome& outcome,
                      std::span<char> text) const {
        RunFacts facts;
        facts.realtime = !options_.virtual_time && os::kernel_is_realtime();
        facts.seed = options_.seed;
        facts.page_faults_after_arming = outcome.page_faults;
        facts.wires = devices.counters();
        facts.stop_reason = outcome.reason;
        facts.contracts_broken = outcome.contracts_broken;
        facts.with_digest = options_.virtual_time;
        std::string measured(64 * 1024, '\0');
        JsonText plant{measured};
        plant.open('{');
        plant_.report(plant);
        plant.close('}');
        if (plant.size() == 0) return 0;
        measured.resize(plant.size());
        if (measured != "{}") {
            os::print(Sentence{name_, ": the plant measured "}.view());
            os::print(measured);
            os::print("\n");
        }
        const std::size_t machine = write_summary(instance, facts, text);
        JsonText ending{text.subspan(machine)};
        if (options_.virtual_time) {
            char digits[16] = {};
            for (std::size_t i = 0; i < 16; ++i)
                digits[i] = "0123456789abcdef"[digest_of(instance, plant_) >> (60 - 4 * i) & 0xF];
            ending.raw(", \"event_log_digest\": \"").raw({digits, 16}).raw("\"");
        }
        ending.raw(", \"plant\": ").raw(measured).raw("}\n");
        return machine == 0 || ending.size() == 0 ? 0 : machine + ending.size();
    }

    const AcceptedMachine& machine_;
    std::string_view name_;
    Plant& plant_;
    const Options& options_;
};

} // namespace

int run_host(const AcceptedMachine& machine,
             const std::function<std::unique_ptr<Plant>(std::uint64_t seed)>& make_plant, int count,
             char** words) {
    const auto options = parse(count, words);
    if (!options) {
        static_cast<void>(os::write_all(2, Sentence{machine.table.name, ": ", options.error(), "\n"}.view()));
        return wrong_set_up;
    }
    const std::unique_ptr<Plant> plant = make_plant(options->seed);
    if (options->help) {
        os::print(
            Sentence{"the machine \"", machine.table.name, "\" with its plant in one process\n"}.view());
        os::print(host_usage);
        os::print(plant->usage());
        return ended_well;
    }
    if (options->plan) {
        describe_plan(machine, nullptr,
                      [](void*, std::string_view line) { os::print(Sentence{line, "\n"}.view()); });
        return ended_well;
    }
    if (options->quiet && std::freopen("/dev/null", "w", stdout) == nullptr) return wrong_set_up;
    const auto host = std::make_unique<Host>(machine, *plant, *options);
    return host->run();
}

} // namespace tappet

// The host's program of a machine, from its command line to its exit code.
#include "toolchain/machine/host.hpp"

#include "kernel/machine/plan_text.hpp"
#include "kernel/os/box.hpp"
#include "kernel/os/terminal.hpp"
#include "kernel/services/json.hpp"
#include "toolchain/machine/host_options.hpp"
#include "toolchain/machine/reasons.hpp"
#include "toolchain/machine/summary.hpp"
#include "toolchain/machine/wires_text.hpp"
#include "toolchain/version.hpp"

#include <cstdio>
#include <string>

namespace tappet {

namespace {

constexpr std::uint64_t default_seed = 1;
enum Ending : int { ended_well = 0, ended_otherwise = 1, wrong_set_up = 2 };

Sentence unknown(std::string_view option) {
    std::vector<std::string_view> names;
    for (const Option& each : host_options) names.push_back(each.name);
    return Sentence{"option ", option, " is unknown", did_you_mean(option, names, "; see --help")};
}

struct Outcome {
    Sentence reason{};
    Sentence unsaved{}; ///< why properties were not saved
    bool well = false;
    std::uint64_t page_faults = 0;
    std::uint64_t contracts_broken = 0;
};

class Host {
public:
    Host(const AcceptedMachine& machine, Plant& plant, const CommandLine& options, const HostHooks& hooks)
        : machine_{machine}, name_{machine.table.name}, plant_{plant}, options_{options}, hooks_{hooks} {}

    int fail(const Sentence& why) const {
        static_cast<void>(os::write_all(2, Sentence{name_, ": ", why, "\n"}.view()));
        return wrong_set_up;
    }
    int run() {
        for (const auto& [option, value] : options_.of_others) {
            Sentence fault;
            if (!plant_.take_option(option, value, fault)) return fail(unknown(option));
            if (!fault.empty()) return fail(Sentence{"option ", option, ": ", fault});
        }
        if (!is_virtual_ && hooks_.look != nullptr && !hooks_.in_real_time)
            return fail(Sentence{"option --real: this program stops its machine to look into it, which needs "
                                 "virtual time; leave it out"});
        return is_virtual_ ? run_virtual() : run_real();
    }

private:
    template <class Run>
    [[nodiscard]] Sentence prepare(Run& run) {
        run.keep_properties_in(options_.text("--properties"));
        run.instance().browse_in(options_.text("--browse"));
        run.devices().record_can(std::string{options_.text("--record-can")});
        for (const auto& [option, value] : options_.options)
            if (option->name == "--replay-can")
                if (const Sentence fault = replay(run.devices(), value); !fault.empty()) return fault;
        return {};
    }
    /// Parses BUS=FILE[@SECONDS].
    static Sentence replay(SimulatedDevices& devices, std::string_view value) {
        const std::size_t equals = value.find('='), at = value.rfind('@');
        std::string_view file = value.substr(std::min(equals, value.size() - 1) + 1);
        Duration begins_at{};
        if (at != value.npos && at > equals) {
            const auto seconds = can::candump::read_seconds(value.substr(at + 1));
            if (!seconds)
                return Sentence{"option --replay-can: behind @ in \"", value, "\": ", seconds.error().what};
            begins_at = *seconds;
            file = value.substr(equals + 1, at - equals - 1);
        }
        if (equals == value.npos || equals == 0 || file.empty())
            return Sentence{"option --replay-can: \"", value, "\" is not BUS=FILE, as in can=shift.log"};
        devices.replay_can(std::string{value.substr(0, equals)}, std::string{file}, begins_at);
        return {};
    }

    /// Short for replays: the run ends soon after its log's end, before the machine misses further frames.
    [[nodiscard]] Duration pace() const { return replays_ ? 1ms : 50ms; }
    [[nodiscard]] Duration time() const {
        if (replays_ && !options_.has("--for")) return 1'000'000'000s;
        return options_.has("--for") ? Duration{std::chrono::seconds{options_.number("--for", 0)}}
                                     : plant_.usual_time();
    }

    int run_virtual() {
        VirtualRun run{machine_, plant_, seed_};
        if (const Sentence fault = prepare(run); !fault.empty()) return fail(fault);
        if (const auto started = run.start(); !started) return fail(started.error());
        const Time end = run.now() + time();
        const auto look = [&] {
            if (hooks_.look != nullptr) hooks_.look(run.instance(), plant_, run.now());
        };
        bool runs = true;
        while (runs && !run.devices().is_done() && run.now() < end) {
            runs = run.run_for(hooks_.look != nullptr ? hooks_.look_every : pace());
            reasons_.tell(run.instance(), name_);
            if (runs) look();
        }
        run.stop();
        look();
        Outcome outcome;
        outcome.unsaved = run.unsaved();
        judge(run.instance(), run.devices(), runs, outcome);
        return finish(run.instance(), run.devices(), outcome);
    }

    int run_real() {
        RealRun run{machine_, plant_, seed_};
        if (const Sentence fault = prepare(run); !fault.empty()) return fail(fault);
        if (const auto started = run.start(2); !started) return fail(started.error());
        bool runs = true;
        for (Duration left = time(); runs && !run.is_done() && left > Duration::zero(); left -= pace()) {
            runs = run.supervise(pace());
            reasons_.tell(run.instance(), name_);
        }
        const int hung = run.stop();
        Outcome outcome;
        outcome.unsaved = run.unsaved();
        judge(run.instance(), run.devices(), runs, outcome);
        outcome.page_faults = run.world().page_faults_in_real_time_threads();
        outcome.contracts_broken = run.world().breaches();
        if (outcome.contracts_broken != 0) outcome.reason = run.world().broken_contract();
        outcome.well &= hung == 0 && outcome.contracts_broken == 0;
        return finish(run.instance(), run.devices(), outcome);
    }

    /// Judges the end. Well: the plant is done, the time is over, or a signal asked it to end.
    void judge(const MachineInstance& instance, const SimulatedDevices& devices, bool runs,
               Outcome& outcome) const {
        const Sentence fault = replays_ ? Sentence{} : plant_.fault(); // a replay's plant has no listeners
        outcome.well = fault.empty() && (runs || instance.stop_request().reason == StopReason::requested);
        outcome.reason = !runs            ? instance.describe_stop()
                         : !fault.empty() ? fault
                         : devices.is_done()
                             ? Sentence{replays_ ? "the log is replayed" : "the plant is done"}
                             : Sentence{"its time is over"};
    }

    int finish(MachineInstance& instance, SimulatedDevices& devices, const Outcome& outcome) {
        os::print(Sentence{name_, ": stopped: ", outcome.reason, "\n"}.view());
        tell_overruns(instance, name_);
        const bool has_logs = devices.close_logs([this](const Sentence& what, bool good) {
            static_cast<void>(os::write_all(good ? 1 : 2, Sentence{name_, ": ", what, "\n"}.view()));
        });
        if (!outcome.unsaved.empty()) return fail(outcome.unsaved);
        std::string text(256 * 1024, '\0');
        const std::size_t length = write(instance, devices, outcome, text);
        if (length == 0) return fail(Sentence{"the summary does not fit its buffer"});
        const std::string path{options_.text("--summary")};
        if (!path.empty() && !os::replace_file(path.c_str(), {text.data(), length}))
            return fail(Sentence{"the summary cannot be written to \"", path,
                                 "\"; name a file in a folder that exists"});
        if (hooks_.ended != nullptr)
            if (const Sentence fault = hooks_.ended(plant_); !fault.empty()) return fail(fault);
        return outcome.well && has_logs ? ended_well : ended_otherwise;
    }

    /// Writes the machine's object with the plant's measurements as one field, and prints it.
    std::size_t write(MachineInstance& instance, const SimulatedDevices& devices, const Outcome& outcome,
                      std::span<char> text) const {
        RunFacts facts;
        facts.realtime = !is_virtual_ && os::kernel_is_realtime();
        facts.seed = seed_;
        facts.page_faults_after_arming = outcome.page_faults;
        facts.wires = devices.counters();
        facts.stop_reason = outcome.reason;
        facts.contracts_broken = outcome.contracts_broken;
        facts.with_digest = is_virtual_;
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
        if (is_virtual_) {
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
    const CommandLine& options_;
    const HostHooks& hooks_;
    std::uint64_t seed_ = options_.number("--seed", default_seed);
    bool replays_ = options_.has("--replay-can");
    bool is_virtual_ = !options_.has("--real");
    ReasonTeller reasons_;
};

} // namespace

namespace {

/// The end of a run whose output was its purpose.
int end_of_output(std::string_view program) {
    if (os::has_printed_all()) return ended_well;
    static_cast<void>(
        os::write_all(2, Sentence{program, ": the output could not be written; is the disk full?\n"}.view()));
    return wrong_set_up;
}

} // namespace

int run_host(const AcceptedMachine& machine,
             const std::function<std::unique_ptr<Plant>(std::uint64_t seed)>& make_plant, int count,
             char** words, const HostHooks& hooks) {
    if (prints_version(count, words, machine.table.name)) return ended_well;
    const std::vector<std::string_view> all(words + 1, words + count);
    const auto options = read_command_line(host_options, all, Others::options);
    if (!options) {
        static_cast<void>(os::write_all(2, Sentence{machine.table.name, ": ", options.error(), "\n"}.view()));
        return wrong_set_up;
    }
    const std::unique_ptr<Plant> plant = make_plant(options->number("--seed", default_seed));
    if (options->has("--help")) {
        os::print(
            Sentence{"the machine \"", machine.table.name, "\" with its plant in one process\n"}.view());
        os::print(usage_of(host_options));
        os::print(plant->usage());
        return ended_well;
    }
    if (options->has("--plan")) {
        describe_plan(machine, nullptr,
                      [](void*, std::string_view line) { os::print(Sentence{line, "\n"}.view()); });
        return end_of_output(machine.table.name);
    }
    if (options->has("--wires")) {
        os::print(describe_wires(machine.table));
        return end_of_output(machine.table.name);
    }
    if (options->has("--quiet") && std::freopen("/dev/null", "w", stdout) == nullptr) return wrong_set_up;
    const auto host = std::make_unique<Host>(machine, *plant, *options, hooks);
    return host->run();
}

} // namespace tappet

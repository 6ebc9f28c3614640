// Runs a firmware from its command line to its exit code.
#include "toolchain/machine/firmware.hpp"

#include "kernel/machine/map/view.hpp"
#include "kernel/machine/plan_text.hpp"
#include "kernel/os/box.hpp"
#include "kernel/os/notify.hpp"
#include "kernel/os/terminal.hpp"
#include "kernel/services/configuration/property_files.hpp"
#include "toolchain/machine/board_text.hpp"
#include "toolchain/machine/guardian.hpp"
#include "toolchain/machine/measure.hpp"
#include "toolchain/machine/reasons.hpp"
#include "toolchain/machine/summary.hpp"
#include "toolchain/version.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

namespace tappet {

namespace {

// These objects are large and exist once: in static memory, not on main's stack.
constinit os::Clock machine_clock{os::Clock::Kind::real};
std::array<char, 48 * 1024> summary_text;
constexpr std::size_t most_own_words = 8;

// How long the supervisor may be silent before its guardian acts. Once all is safe, the machine's hook and
// the saving of properties may take a long time, within reason.
constexpr Duration away_while_running = 2s;
constexpr Duration away_when_safe = 30s;

struct Options {
    const char* summary = nullptr;
    const char* properties = nullptr;
    const char* take_over = nullptr;
    const char* browse = nullptr;
    const char* seconds = nullptr;
    const char* measure = nullptr;
    const char* black_box = nullptr;
    Duration time = Duration::max();
    Duration measured{};
    bool help = false;
    bool plan = false;
    bool board = false;
    bool guarded = true;
    Bounded<char*, most_own_words> own{}; ///< words for the machine's hook
    Sentence error{};
};

constexpr std::string_view usage =
    "  --summary FILE     writes its counters to FILE as JSON when it ends\n"
    "  --properties DIR   reads saved properties in DIR and saves them there at the end (default: the "
    "board's directory)\n"
    "  --take-over DIR    takes over newer properties that another version of the machine saved in DIR, "
    "where they fit\n"
    "  --browse DIR       opens the browsers' socket in DIR (default: the board's directory)\n"
    "  --black-box DIR    writes the black box of a crash or another unrequested end to DIR (default: the "
    "board's directory)\n"
    "  --for SECONDS      ends by itself after SECONDS\n"
    "  --no-guardian      for tests: no guardian; after a crash the outputs keep their levels\n"
    "  --plan             prints what the compiler derived from the table: priorities, order, mailboxes, "
    "memory\n"
    "  --board            prints what the box's image must bring up for the machine\n"
    "  --measure SECONDS  measures whether this box can hold the table's claims; the machine does not run\n"
    "  --version          prints the version of Tappet that it was built from\n"
    "  --help             this text\n";

void read_seconds(std::string_view option, const char* given, Duration& into, Sentence& error) {
    if (given == nullptr) return;
    const std::string_view digits = given;
    std::uint32_t seconds = 0;
    const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), seconds);
    if (fault != std::errc{} || end != digits.data() + digits.size() || seconds == 0)
        error = Sentence{"option ", option, ": \"", digits, "\" is not a time; write whole seconds, as in ",
                         option,    " 60"};
    else
        into = std::chrono::seconds{seconds};
}

Options parse(int count, char** words, bool has_own) {
    Options options;
    for (int i = 1; i < count && options.error.empty(); ++i) {
        const std::string_view word = words[i];
        const char** place = word == "--summary"      ? &options.summary
                             : word == "--properties" ? &options.properties
                             : word == "--take-over"  ? &options.take_over
                             : word == "--browse"     ? &options.browse
                             : word == "--for"        ? &options.seconds
                             : word == "--measure"    ? &options.measure
                             : word == "--black-box"  ? &options.black_box
                                                      : nullptr;
        if (word == "--help")
            options.help = true;
        else if (word == "--plan")
            options.plan = true;
        else if (word == "--board")
            options.board = true;
        else if (word == "--no-guardian")
            options.guarded = false;
        else if (place == nullptr && !(has_own && options.own.push(words[i])))
            options.error = Sentence{"option ", word, " is unknown; --help lists the options"};
        else if (place != nullptr && i + 1 == count)
            options.error = Sentence{"option ", word, " needs a value after it"};
        else if (place != nullptr)
            *place = words[++i];
    }
    read_seconds("--for", options.seconds, options.time, options.error);
    read_seconds("--measure", options.measure, options.measured, options.error);
    return options;
}

/// The work of the supervisor while it waits.
struct GuardLook {
    os::Guard& guard;
    MachineInstance& instance;
};

/// One run of the firmware; each line that it prints begins with its name.
class Run {
public:
    Run(const AcceptedMachine& machine, GuardedDevices& devices, const FirmwareHooks& hooks,
        const Options& options)
        : name_{machine.table.name}, devices_{devices}, hooks_{hooks}, options_{options} {}

    Ending fail(Ending ending, const Sentence& why) const {
        static_cast<void>(os::write_all(2, Sentence{name_, ": ", why, "\n"}.view()));
        return ending;
    }
    template <class... Words>
    void say(const Words&... words) const {
        os::print(Sentence{name_, ": ", words..., "\n"}.view());
    }

    int live(MachineInstance& instance, RealWorld& world, PropertyFiles& properties, Time begun) {
        if (options_.guarded) instance.be_guarded();
        if (const Ending prepared = prepare(instance, properties); prepared != Ending::well)
            return static_cast<int>(prepared);
        if (options_.guarded) {
            const auto side = guard_.split();
            if (!side) return static_cast<int>(fail(Ending::wrong_set_up, side.error()));
            instance.keep_stop_request_in(guard_.machines_own());
            if (*side == os::Guard::Side::guardian) {
                os::Guard::forget(properties);
                os::Guard::forget(world);
                be_guardian(guard_, devices_, instance,
                            options_.black_box != nullptr ? std::string_view{options_.black_box}
                                                          : instance.machine().board->black_box_directory);
            }
            instance.observation().be_this_process();
        }
        return static_cast<int>(run(instance, world, properties, begun));
    }

private:
    /// Prepares the machine until it could arm. The guardian is forked from this state.
    Ending prepare(MachineInstance& instance, PropertyFiles& properties) {
        if (const auto opened = devices_.open(instance.machine()); !opened)
            return fail(Ending::wrong_set_up, opened.error());
        instance.read_properties_from(properties.store());
        if (options_.browse != nullptr) instance.browse_in(options_.browse);
        if (const auto configured = instance.configure(devices_.provided()); !configured)
            return fail(Ending::wrong_set_up, configured.error());
        if (options_.take_over != nullptr)
            if (const Sentence fault = instance.save_properties(instance.standing()); !fault.empty())
                return fail(Ending::wrong_set_up, fault);
        if (hooks_.configured != nullptr) hooks_.configured(instance);
        return Ending::well;
    }

    Ending run(MachineInstance& instance, RealWorld& world, PropertyFiles& properties, Time begun) {
        const Board& board = *instance.machine().board;
        static os::ArmingReport arming{{board.only_warned.begin(), board.only_warned.end()}};
        devices_.report(arming); // an unfit device was refused when it was opened
        report_guardian(arming);
        const auto armed = world.arm(arming, 2);
        if (!armed) {
            guard_.end(os::Guard::Outputs::safe, {});
            return Ending::refused_to_arm;
        }
        const Duration start_to_armed = machine_clock.now() - begun;
        // Also during the start, when nothing else checks whether the guardian lives.
        GuardLook look{guard_, instance};
        world.show_life_by(&look, [](void* self) {
            auto& both = *static_cast<GuardLook*>(self);
            both.guard.be_back_within(away_while_running);
            if (both.guard.guardian_is_lost()) both.instance.ask_stop(StopReason::requested, 0, nullptr);
        });
        guard_.be_back_within(away_while_running);
        guard_.let_activities_be_watched(true);
        if (!world.start(*armed)) return end(instance, world, properties, start_to_armed, false);
        say("armed on board \"", board.name, "\", ", static_cast<std::int64_t>(arming.warnings()),
            " warnings, ", start_to_armed.count() / 1000, " us after its start");
        os::notify_starter("READY=1");
        const bool time_is_over = supervise(instance, world);
        return end(instance, world, properties, start_to_armed, time_is_over);
    }

    void report_guardian(os::ArmingReport& report) {
        if (!guard_.is_split())
            report.warning("guardian", Sentence{"the machine has none"}, Sentence{"leave out --no-guardian"});
        else if (const Sentence why = guard_.wait_for_guardian(); !why.empty())
            report.fault("guardian", why, Sentence{"see the reason"});
        else if (!guard_.guardian_is_spared())
            report.warning("guardian", Sentence{"the kernel may end it when memory is short"},
                           Sentence{"run as root or grant CAP_SYS_RESOURCE"});
        else
            report.passed("guardian", Sentence{"it could act now"});
    }

    /// Asks the guardian to write safe outputs too when a thread broke a contract, or when a device did not
    /// accept safe values. The guardian ends a hung thread, and the process with it.
    static os::Guard::Outputs outputs_of(MachineInstance& instance, const RealWorld& world) {
        const bool is_sure = world.lost() == 0 && instance.life().left_unsafe().empty();
        return world.hung() != 0 ? os::Guard::Outputs::unsafe
               : is_sure         ? os::Guard::Outputs::safe
                                 : os::Guard::Outputs::not_sure;
    }

    /// Supervises the machine. Returns true when its time is over.
    bool supervise(MachineInstance& instance, RealWorld& world) {
        const Time begin = machine_clock.now();
        ReasonTeller reasons;
        bool judged = false;
        for (int look = 1;; ++look) {
            const Duration left = options_.time - (machine_clock.now() - begin);
            if (left <= Duration::zero()) return true;
            guard_.be_back_within(away_while_running);
            if (guard_.guardian_is_lost()) return false;
            if (!world.supervise(std::min<Duration>(left, 100ms))) return false;
            reasons.tell(instance, name_);
            if (!judged) judged = judge(instance, machine_clock.now() - begin);
            if (look % 10 == 0) print_timing(instance);
        }
    }

    /// Judges a new version: it stays on the box once it has met its binding's proof, and is replaced when it
    /// is late. Returns true when nothing is left to report.
    static bool judge(MachineInstance& instance, Duration running) {
        for (const Engine& engine : instance.engines()) {
            if (!engine.plan().real_time || engine.statistics().misses == 0) continue;
            os::notify_starter(Sentence{"X_TAPPET_LATE=", engine.name()}.view());
            return true;
        }
        if (!is_proven(instance, running)) return false;
        os::notify_starter("X_TAPPET_PROVEN=1");
        return true;
    }

    static bool is_proven(MachineInstance& instance, Duration running) {
        const Proof& proof = instance.machine().binding->proof;
        if (proof.output.empty()) return running >= 60s;
        End end{};
        static_cast<void>(resolve(instance.machine().table, proof.output, FacetKind::output, end));
        std::int64_t count = 0;
        const auto read = [&] {
            count = static_cast<const Output<std::int64_t>*>(instance.facet(end))->last();
        };
        // Another thread writes this: values written meanwhile are read the next time. Without an observer
        // there are no generations, but an aligned word is read atomically.
        const auto activity = static_cast<std::uint32_t>(instance.machine().index.activity[end.component]);
        const auto view = map::View::open(instance.observation().shared_memory());
        if (!view)
            read();
        else if (!view->consistent(activity, proof_attempts, read))
            return false;
        return count >= proof.count;
    }
    static constexpr int proof_attempts = 100;

    Ending end(MachineInstance& instance, RealWorld& world, PropertyFiles& properties,
               Duration start_to_armed, bool time_is_over) {
        const bool unguarded = guard_.guardian_is_lost();
        instance.ask_stop(StopReason::requested, 0, nullptr); // if nobody asked: its bound counts from here
        guard_.let_activities_be_watched(false);
        guard_.be_back_within(std::max(away_while_running, instance.machine().board->stop_within));
        static_cast<void>(world.make_safe());
        const Sentence reason = unguarded ? Sentence{"its guardian is gone, or hangs"}
                                : !world.broken_contract().empty() ? world.broken_contract()
                                : !world.refusal().empty()         ? world.refusal()
                                : time_is_over                     ? Sentence{"its time is over"}
                                                                   : instance.describe_stop();
        const bool as_asked = !unguarded &&
                              (time_is_over || instance.stop_request().reason == StopReason::requested) &&
                              world.breaches() == 0;
        Sentence fault = reason;
        if (world.hung() != 0) fault.add("; activity \"").add(world.first_hung()).add("\" does not stop");
        if (const std::string_view driver = instance.life().left_unsafe(); !driver.empty())
            fault.add("; the safe values of \"").add(driver).add("\" did not reach its device");
        say("stopped: ", fault);
        const auto outputs = outputs_of(instance, world);
        guard_.end(outputs, as_asked && outputs == os::Guard::Outputs::safe ? Sentence{} : fault);
        static_cast<void>(world.stop()); // finalises
        if (!world.unfinished().empty()) say(world.unfinished());
        if (!world.refusal().empty()) return fail(Ending::stopped_by_fault, world.refusal());
        guard_.be_back_within(away_when_safe); // time to save and to sum up
        for (std::size_t i = 1; i < std::min(world.breaches(), RealWorld::max_breaches); ++i)
            say("then: ", world.describe_breach(i));
        tell_overruns(instance, name_);
        if (properties.keeps())
            if (const Sentence unsaved = instance.save_properties(instance.standing()); !unsaved.empty())
                say(unsaved);
        if (hooks_.ended != nullptr) hooks_.ended(instance, world);
        if (options_.summary != nullptr)
            if (const Ending written = write(instance, world, reason, start_to_armed);
                written != Ending::well)
                return written;
        return as_asked && world.hung() == 0 ? Ending::well : Ending::stopped_by_fault;
    }

    Ending write(MachineInstance& instance, const RealWorld& world, const Sentence& reason,
                 Duration start_to_armed) const {
        RunFacts facts;
        facts.realtime = os::kernel_is_realtime();
        facts.page_faults_after_arming = world.page_faults_in_real_time_threads();
        facts.wires = devices_.counters();
        facts.stop_reason = reason;
        facts.contracts_broken = world.breaches();
        facts.start_to_armed = start_to_armed;
        const std::size_t length = write_summary(instance, facts, summary_text);
        if (length == 0 || length + 2 > summary_text.size())
            return fail(Ending::wrong_set_up, Sentence{"the summary does not fit its buffer"});
        summary_text[length] = '}';
        summary_text[length + 1] = '\n';
        if (!os::replace_file(options_.summary, {summary_text.data(), length + 2}))
            return fail(Ending::wrong_set_up, Sentence{"the summary cannot be written to \"",
                                                       std::string_view{options_.summary}, "\""});
        return Ending::well;
    }

    /// Prints one line: each real-time activity's worst response and its deadline, in us.
    static void print_timing(const MachineInstance& instance) {
        Sentence line{"timing"};
        std::uint64_t misses = 0;
        for (const Engine& engine : instance.engines()) {
            if (!engine.plan().real_time) continue;
            const EngineStatistics& seen = engine.statistics();
            misses += seen.misses;
            line.add(" ")
                .add(engine.name())
                .add("=")
                .add(seen.longest_response.count() / 1000)
                .add("/")
                .add(engine.plan().deadline.count() / 1000)
                .add("us");
        }
        line.add(" misses=").add(misses).add("\n");
        os::print(line.view());
    }

    std::string_view name_;
    GuardedDevices& devices_;
    const FirmwareHooks& hooks_;
    const Options& options_;
    os::Guard guard_{};
};

} // namespace

int run_firmware(const AcceptedMachine& machine, GuardedDevices& devices, int count, char** words,
                 const FirmwareHooks& hooks) {
    if (prints_version(count, words, machine.table.name)) return 0;
    const Time begun = machine_clock.now() - os::own_processor_time(); // when the kernel began to load it
    const Options options = parse(count, words, hooks.take != nullptr);
    Run run{machine, devices, hooks, options};
    if (!options.error.empty()) return static_cast<int>(run.fail(Ending::wrong_set_up, options.error));
    if (options.help) {
        os::print(Sentence{"the firmware of the machine \"", machine.table.name, "\" for board \"",
                           machine.board->name, "\"\n"}
                      .view());
        os::print(usage);
        return 0;
    }
    const auto print_line = [](void*, std::string_view line) { os::print(Sentence{line, "\n"}.view()); };
    if (options.plan) describe_plan(machine, nullptr, print_line);
    if (options.board) describe_board(machine, nullptr, print_line);
    if (options.plan || options.board)
        return os::has_printed_all()
                   ? 0
                   : static_cast<int>(
                         run.fail(Ending::wrong_set_up, Sentence{"the output could not be written; is "
                                                                 "the disk full?"}));
    if (options.measure != nullptr) return measure_box(machine, options.measured);
    if (hooks.take != nullptr)
        if (const Sentence refusal = hooks.take({options.own.begin(), options.own.size()}); !refusal.empty())
            return static_cast<int>(run.fail(Ending::wrong_set_up, refusal));
    static MachineInstance instance{machine, machine_clock};
    static PropertyFiles properties{options.properties != nullptr ? std::string_view{options.properties}
                                                                  : machine.board->properties_directory};
    if (options.take_over != nullptr)
        properties.take_over(options.take_over, [](const Sentence& fault) {
            os::print(Sentence{"left out: ", fault, "\n"}.view());
        });
    static RealWorld world{instance};
    return run.live(instance, world, properties, begun);
}

} // namespace tappet

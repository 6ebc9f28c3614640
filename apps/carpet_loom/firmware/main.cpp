// The carpet loom's firmware: one machine, one board, one static binary.
#include "apps/carpet_loom/firmware/devices.hpp"
#include "apps/carpet_loom/machine.hpp"
#include "apps/carpet_loom/summary.hpp"
#include "kernel/machine/firmware.hpp"
#include "kernel/machine/worlds/real_world.hpp"
#include "kernel/os/box.hpp"
#include "kernel/os/heap.hpp"
#include "kernel/os/terminal.hpp"
#include "kernel/services/configuration/property_files.hpp"

#include TAPPET_BOARD_HEADER

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

TAPPET_HEAP_ARENA(tappet::board::TAPPET_BOARD.heap_bytes)

namespace {

using namespace tappet;

constexpr const Board& board_here = board::TAPPET_BOARD;
using LoomFirmware = Firmware<carpet::carpet_loom, board_here>;

enum Ending : int { ended_well = 0, wrong_set_up = 2, refused_to_arm = 3, stopped_by_fault = 4 };

// Large, and there once: in static memory, not on main's stack.
constinit os::Clock machine_clock{os::Clock::Kind::real};
std::array<char, 32 * 1024> summary_text;

int fail(Ending ending, const Sentence& why) {
    static_cast<void>(os::write_all(2, Sentence{"carpet-loom: ", why, "\n"}.view()));
    return ending;
}

/// `--summary FILE`, `--properties DIRECTORY` and `--browse DIRECTORY` (of the browsers' socket) instead of
/// the board's: everything else is in the table and in the board.
struct Options {
    const char* summary = nullptr;
    const char* properties = nullptr;
    const char* browse = nullptr;
    Sentence error{};
};

Options parse(int count, char** words) {
    Options options;
    for (int i = 1; i < count; ++i) {
        const char** place = std::strcmp(words[i], "--summary") == 0      ? &options.summary
                             : std::strcmp(words[i], "--properties") == 0 ? &options.properties
                             : std::strcmp(words[i], "--browse") == 0     ? &options.browse
                                                                          : nullptr;
        if (place == nullptr)
            options.error = Sentence{
                "option ", std::string_view{words[i]},
                " is unknown; there are --summary FILE, --properties DIRECTORY and --browse DIRECTORY"};
        else if (i + 1 == count)
            options.error = Sentence{"option ", std::string_view{words[i]}, " needs a name after it"};
        else
            *place = words[++i];
    }
    return options;
}

int write_summary(MachineInstance& instance, const RealWorld& world, const carpet::Devices& devices,
                  const Sentence& reason, Duration start_to_armed, const char* path) {
    const auto* bus = instance.find<can::Bus<carpet::can_signals>>("can");
    const auto* utility = instance.find<modbus::Client<carpet::utility_registers>>("utility");
    carpet::RunFacts facts;
    facts.world = board_here.world;
    facts.realtime = os::kernel_is_realtime();
    facts.page_faults_after_arming = world.page_faults_in_real_time_threads();
    facts.can_frames_lost = devices.can().counters().lost_in_kernel;
    facts.gpio_edges_lost = devices.lines().counters().missed;
    facts.modbus_outages_survived = utility->counters().outages_survived;
    const can::Counters seen = devices.can().counters();
    facts.wires = {seen.faults, seen.restarts, bus->decoding().wrong_lengths, seen.impostors, seen.malformed};
    facts.stop_reason = reason.view();
    facts.contracts_broken = world.breaches();
    facts.start_to_armed = start_to_armed;
    const std::size_t length = carpet::write_machine_summary(instance, facts, summary_text);
    if (length == 0 || length + 2 > summary_text.size())
        return fail(wrong_set_up, Sentence{"the summary does not fit its buffer"});
    summary_text[length] = '}';
    summary_text[length + 1] = '\n';
    if (!os::replace_file(path, {summary_text.data(), length + 2}))
        return fail(wrong_set_up,
                    Sentence{"the summary cannot be written to \"", std::string_view{path}, "\""});
    return ended_well;
}

/// One line: each real-time activity's worst response and its deadline, in us.
void print_timing(const MachineInstance& instance) {
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

/// Says once why the loom left its state, for each transition that gives a reason.
void tell_reason(const StateMachineExecution& loom, StateMachineExecution::News& told) {
    const StateMachineExecution::News news = loom.news();
    if (news == told) return;
    told = news;
    const auto rows = loom.machine().table.transitions;
    if (news.transition >= rows.size()) return; // to the final state: the machine's own stop says why
    os::print(Sentence{"carpet-loom: the loom goes to \"", rows[news.transition].to,
                       "\": ", rows[news.transition].because, "\n"}
                  .view());
}

void list_misses(const MachineInstance& instance) {
    for (std::size_t a = 0; a < instance.engines().size(); ++a)
        for (const Sentence& told :
             {instance.observation().describe_budget(a), instance.observation().describe_end(a)})
            if (!told.empty()) os::print(Sentence{"carpet-loom: ", told, "\n"}.view());
    for (const Engine& engine : instance.engines()) {
        const EngineStatistics& seen = engine.statistics();
        if (seen.misses == 0) continue;
        const Miss& last = seen.recent_misses[(seen.misses - 1) % seen.recent_misses.size()];
        const std::string_view culprit = last.function == Miss::nobody
                                             ? std::string_view{"it began late"}
                                             : engine.plan().parts[last.function / functions_per_part].name;
        os::print(Sentence{"carpet-loom: activity \"", engine.name(), "\" missed its deadline ",
                           static_cast<std::int64_t>(seen.misses), " times; the last time ", culprit,
                           " took ", last.took.count() / 1000, " us, usually ", last.usual.count() / 1000,
                           " us\n"}
                      .view());
    }
}

} // namespace

int main(int count, char** words) {
    const Time begun = machine_clock.now() - os::own_processor_time(); // when the kernel began to load us
    const Options options = parse(count, words);
    if (!options.error.empty()) return fail(wrong_set_up, options.error);

    static carpet::Devices devices;
    if (const auto opened = devices.open(board_here); !opened) return fail(wrong_set_up, opened.error());
    static MachineInstance instance{LoomFirmware::machine(), machine_clock};
    static PropertyFiles properties{options.properties != nullptr ? std::string_view{options.properties}
                                                                  : board_here.properties_directory};
    instance.read_properties_from(properties.store());
    if (options.browse != nullptr) instance.browse_in(options.browse);
    if (const auto configured = instance.configure(devices.provided()); !configured)
        return fail(wrong_set_up, configured.error());

    static RealWorld world{instance};
    static os::ArmingReport arming{{board_here.only_warned.begin(), board_here.only_warned.end()}};
    arming.passed("can-bus", devices.can().found()); // a bus that is not fit was refused when it was opened
    os::print(Sentence{"carpet-loom: ", devices.can().found(), "\n"}.view());
    const auto armed = world.arm(arming, 2);
    if (!armed) return refused_to_arm;
    const Duration start_to_armed = machine_clock.now() - begun;
    if (!world.start(*armed)) return fail(stopped_by_fault, world.refusal());
    os::print(Sentence{"carpet-loom: armed on board \"", board_here.name, "\", ",
                       static_cast<std::int64_t>(arming.warnings()), " warnings, ",
                       start_to_armed.count() / 1000, " us after its start\n"}
                  .view());
    StateMachineExecution::News told;
    for (int look = 1; world.supervise(100ms); ++look) {
        tell_reason(*instance.state_machine_of("loom"), told);
        if (look % 10 == 0) print_timing(instance);
    }

    const int hung = world.stop();
    const Sentence reason =
        world.broken_contract().empty() ? instance.describe_stop() : world.broken_contract();
    os::print(Sentence{"carpet-loom: stopped: ", reason, "\n"}.view());
    for (std::size_t i = 1; i < std::min(world.breaches(), RealWorld::max_breaches); ++i)
        os::print(Sentence{"carpet-loom: then: ", world.describe_breach(i), "\n"}.view());
    list_misses(instance);
    if (properties.keeps())
        if (const Sentence fault = instance.save_properties(instance.standing()); !fault.empty())
            os::print(Sentence{"carpet-loom: ", fault, "\n"}.view());
    if (options.summary != nullptr)
        if (const int written =
                write_summary(instance, world, devices, reason, start_to_armed, options.summary);
            written != ended_well)
            return written;
    const bool as_asked = hung == 0 && world.breaches() == 0;
    return as_asked && instance.stop_request().reason == StopReason::requested ? ended_well
                                                                               : stopped_by_fault;
}

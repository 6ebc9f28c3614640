// bench-probe FAULT: arms, runs for a third of a second, commits the fault meanwhile, and tells what the
// machine noticed.
#include "kernel/machine/firmware.hpp"
#include "kernel/machine/worlds/real_world.hpp"
#include "kernel/os/heap.hpp"
#include "kernel/os/terminal.hpp"
#include "tests/bench/probe/machine.hpp"

#include "board/bench/board.hpp"

#include <cstring>

TAPPET_HEAP_ARENA(tappet::board::bench.heap_bytes)

namespace {

using namespace tappet;
using ProbeFirmware = Firmware<probe::bench_probe, board::bench>;

enum Ending : int { ended_well = 0, wrong_set_up = 2, refused_to_arm = 3, stopped_by_fault = 4 };

constinit os::Clock machine_clock{os::Clock::Kind::real};

bool find_fault(const char* word, probe::Fault& fault) {
    for (std::size_t i = 0; i < probe::fault_names.size(); ++i)
        if (probe::fault_names[i] == word) {
            fault = static_cast<probe::Fault>(i);
            return true;
        }
    return false;
}

void print_counters(const MachineInstance& instance, const RealWorld& world, bool left_safe) {
    const EngineStatistics& seen = instance.engines()[0].statistics();
    os::print(Sentence{"bench-probe: allocations=", os::heap::allocations_after_seal(),
                       " mappings=", os::heap::mappings_after_seal(),
                       " page_faults=", world.page_faults_in_real_time_threads(), " misses=", seen.misses,
                       " safe=", left_safe ? "yes" : "no", "\n"}
                  .view());
    if (seen.misses == 0) return;
    const Miss& miss = seen.recent_misses[0];
    const std::string_view culprit =
        miss.function == Miss::nobody
            ? std::string_view{"nobody"}
            : instance.engines()[0].plan().parts[miss.function / functions_per_part].name;
    os::print(Sentence{"bench-probe: the first miss is blamed on ", culprit, "\n"}.view());
}

} // namespace

int main(int count, char** words) {
    probe::Fault fault{};
    if (count != 2 || !find_fault(words[1], fault)) {
        os::print("usage: bench-probe nothing|allocate|map|touch|overrun|break-contract\n");
        return wrong_set_up;
    }
    static MachineInstance instance{ProbeFirmware::machine(), machine_clock};
    if (const auto configured = instance.configure({}); !configured) {
        os::print(Sentence{"bench-probe: ", configured.error(), "\n"}.view());
        return wrong_set_up;
    }
    auto* culprit = instance.find<probe::Culprit>("culprit");
    culprit->fault = fault;

    static RealWorld world{instance};
    static os::ArmingReport arming{{board::bench.only_warned.begin(), board::bench.only_warned.end()}};
    const auto armed = world.arm(arming, 2);
    if (!armed) return refused_to_arm;
    if (!world.start(*armed)) return stopped_by_fault;
    const bool by_itself = !world.supervise(300ms);
    static_cast<void>(world.stop());
    const Sentence reason = !by_itself                        ? Sentence{"its time is over"}
                            : world.broken_contract().empty() ? instance.describe_stop()
                                                              : world.broken_contract();
    os::print(Sentence{"bench-probe ", std::string_view{words[1]}, ": stopped: ", reason, "\n"}.view());
    print_counters(instance, world, culprit->left_safe);
    return by_itself ? stopped_by_fault : ended_well;
}

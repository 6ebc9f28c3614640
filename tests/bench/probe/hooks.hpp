// bench-probe FAULT: the fault to commit, and the machine's observations of it.
#pragma once

#include "kernel/os/heap.hpp"
#include "kernel/os/terminal.hpp"
#include "tests/bench/probe/probe.hpp"
#include "toolchain/machine/firmware.hpp"

namespace tappet::probe {

inline Fault chosen{};

inline Sentence take_fault(std::span<char* const> words) {
    for (std::size_t i = 0; words.size() == 1 && i < fault_names.size(); ++i)
        if (fault_names[i] == std::string_view{words[0]}) {
            chosen = static_cast<Fault>(i);
            return {};
        }
    return Sentence{"say one of nothing, allocate, map, touch, overrun, break-contract, crash, hang"};
}

inline void plant_fault(MachineInstance& instance) { instance.find<Culprit>("culprit")->fault = chosen; }

inline void print_counters(MachineInstance& instance, const RealWorld& world) {
    const Engine& engine = instance.engines()[0];
    const EngineStatistics& seen = engine.statistics();
    os::print(Sentence{"bench-probe ", fault_names[static_cast<std::size_t>(chosen)], ": allocations=",
                       os::heap::allocations_after_seal(), " mappings=", os::heap::mappings_after_seal(),
                       " page_faults=", world.page_faults_in_real_time_threads(), " misses=", seen.misses,
                       " safe=", instance.find<Culprit>("culprit")->left_safe ? "yes" : "no", "\n"}
                  .view());
    if (seen.misses == 0) return;
    const Miss& miss = seen.recent_misses[0];
    const std::string_view culprit = miss.function == Miss::nobody
                                         ? std::string_view{"nobody"}
                                         : engine.plan().parts[miss.function / functions_per_part].name;
    os::print(Sentence{"bench-probe: the first miss is blamed on ", culprit, "\n"}.view());
}

inline constexpr FirmwareHooks firmware_hooks{&take_fault, &plant_fault, &print_counters};

} // namespace tappet::probe

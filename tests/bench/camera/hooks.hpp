// Prints what the viewer has seen, at the end.
#pragma once

#include "kernel/os/heap.hpp"
#include "kernel/os/terminal.hpp"
#include "tests/bench/camera/machine.hpp"
#include "toolchain/machine/firmware.hpp"

namespace tappet::camera_bench {

inline void print_counters(MachineInstance& instance, const RealWorld& world) {
    Viewer& seen = *instance.find<Viewer>("viewer");
    const auto& sensor = *instance.find<camera::Sensor<Viewer::columns, Viewer::rows>>("sensor");
    const camera::Counters count = sensor.counters();
    const EngineStatistics& engine = instance.engines()[0].statistics();
    os::print(Sentence{"camera-bench: images=",
                       seen.images,
                       " frames=",
                       count.frames,
                       " lost=",
                       count.lost,
                       " flawed=",
                       count.flawed,
                       " repeated=",
                       count.repeated,
                       " late=",
                       count.late,
                       " apart=",
                       seen.closest / 1ms,
                       "..",
                       seen.farthest / 1ms,
                       " ms oldest=",
                       seen.oldest / 1ms,
                       " ms brightest=",
                       int{seen.brightest},
                       " faults=",
                       seen.faults,
                       " recoveries=",
                       seen.recoveries,
                       " cycles=",
                       engine.cycles,
                       " misses=",
                       engine.misses,
                       " allocations=",
                       os::heap::allocations_after_seal(),
                       " page_faults=",
                       world.page_faults_in_real_time_threads(),
                       "\n"}
                  .view());
}

inline constexpr FirmwareHooks firmware_hooks{nullptr, nullptr, &print_counters};

} // namespace tappet::camera_bench

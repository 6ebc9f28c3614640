// An industrial PC with an aarch64 processor: a fanless box with four cores (with the atomic instructions of
// version 8.1), two CAN controllers, a GPIO chip of 32 lines, an Ethernet port and a serial port.
#pragma once

#include "drivers/can/kind.hpp"
#include "drivers/gpio/kind.hpp"
#include "kernel/machine/table/board.hpp"

namespace tappet::board {

inline constexpr Board ipc_aarch64{
    .name = "ipc-aarch64",
    .world = "box",
    .memory_budget_bytes = 4 * 1024 * 1024,
    .heap_bytes = 160 * 1024,
    .processors = 4,
    .highest_priority = 80, // interrupt threads of CAN and GPIO have a higher priority than every activity
    // Processors 2 and 3 are isolated (see the command line): a machine runs on 2; its binding may
    // place parts on 3, or on 0 and 1 together with the interrupts.
    .default_processor = 2,
    .devices = board_devices(board_device("can0", "can", "can0", bit_rate(1'000'000)),
                             board_device("can1", "can", "can1", bit_rate(1'000'000)),
                             // By the chip's label, as gpiodetect shows it, because numbers depend on the
                             // order in which drivers load.
                             board_device("io", "gpio", "gpio0", lines(32)),
                             board_device("serial1", "serial", "/dev/ttyAMA0")),
    .only_warned = {},
    // Isolated processors without ticks and callbacks; no sleep, no frequency changes; late interrupts on 0
    // and 1.
    .kernel_command_line =
        "isolcpus=managed_irq,domain,2,3 nohz_full=2,3 rcu_nocbs=2,3 rcu_nocb_poll irqaffinity=0,1 "
        "cpuidle.off=1 nosoftlockup nowatchdog audit=0 cpufreq.default_governor=performance mitigations=auto "
        "sysctl.kernel.sched_rt_runtime_us=-1 quiet panic=5",
    .properties_directory = "/var/lib/tappet",
    // Only root, until the box has groups for its people: name them here.
    .browsing = {.directory = "/run/tappet", .mode = 0660},
    .black_box_directory = "/var/lib/tappet",
    .watchdog = "/dev/watchdog",
};

} // namespace tappet::board

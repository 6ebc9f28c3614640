// An industrial PC of the common kind: a fanless x86-64 box with two to four cores, a PCIe or SPI CAN
// controller, 16 to 32 digital lines on an isolated GPIO chip, two Ethernet ports and a serial port.
#pragma once

#include "drivers/can/kind.hpp"
#include "drivers/gpio/kind.hpp"
#include "kernel/machine/table/board.hpp"

namespace tappet::board {

inline constexpr Board ipc_x86_64{
    .name = "ipc-x86_64",
    .world = "box",
    .memory_budget_bytes = 4 * 1024 * 1024,
    .heap_bytes = 160 * 1024,
    .processors = 4,
    .highest_priority = 80, // interrupt threads of CAN and GPIO have a higher priority than every activity:
                            // see README.md here
    // Processors 2 and 3 are isolated (see the command line): a machine runs on 2; its binding may
    // place parts on 3, or on 0 and 1 together with the interrupts.
    .default_processor = 2,
    .devices = board_devices(board_device("can0", "can", "can0", bit_rate(1'000'000)),
                             board_device("can1", "can", "can1", bit_rate(1'000'000)),
                             // By the chip's label, as gpiodetect shows it, because numbers depend on the
                             // order in which drivers load.
                             board_device("io", "gpio", "INTC1020:00", lines(32)),
                             board_device("serial1", "serial", "/dev/ttyS0"),
                             board_device("serial2", "serial", "/dev/ttyS1")),
    .only_warned = {},
    // Isolated processors without ticks and callbacks; no deep sleep, no frequency changes; late interrupts
    // on 0 and 1.
    .kernel_command_line =
        "isolcpus=managed_irq,domain,2,3 nohz_full=2,3 rcu_nocbs=2,3 rcu_nocb_poll irqaffinity=0,1 "
        "processor.max_cstate=1 intel_idle.max_cstate=0 tsc=reliable nosoftlockup nowatchdog mce=ignore_ce "
        "audit=0 nosmt cpufreq.default_governor=performance mitigations=auto "
        "sysctl.kernel.sched_rt_runtime_us=-1 quiet panic=5",
    .image = {.modules = kernel_modules(
                  // Disks, searched in parallel with the other modules; the file systems of data and slots.
                  "nvme async_probe", "ahci async_probe", "sd_mod", "ext4", "vfat", "nls_cp437", "nls_ascii",
                  // CAN controllers, and the watchdogs of common chip sets.
                  "can-raw", "peak_pci", "peak_pciefd", "kvaser_pci", "ems_pci", "i2c-i801",
                  "iTCO_wdt heartbeat=10 nowayout=1", "wdat_wdt nowayout=1",
                  "sp5100_tco heartbeat=10 nowayout=1", "i6300esb heartbeat=10 nowayout=1"),
              .later_modules = kernel_modules(
                  // USB sticks.
                  "usb-storage", "xhci-pci", "ehci-pci",
                  // The port to the utility unit; the power button.
                  "igb", "igc", "e1000e", "r8169", "realtek", "button", "evdev"),
              .consoles = consoles("tty0", "ttyS0,115200"),
              // For the utility unit, and for the service engineer.
              .networks = networks(ethernet("eth0", "192.168.7.1/24"), ethernet("eth1", "192.168.8.1/24")),
              .interrupt_priority = 85,
              .service_port = 4848},
    .properties_directory = "/var/lib/tappet",
    // Only root, until the box's image has groups for its people: name them here.
    .browsing = {.directory = "/run/tappet", .mode = 0660},
    .black_box_directory = "/var/lib/tappet",
    .watchdog = "/dev/watchdog",
};

} // namespace tappet::board

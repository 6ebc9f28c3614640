// The bench: a PREEMPT_RT guest under QEMU with vcan, gpio-sim and Modbus servers on its loopback or on pairs
// of pseudo-terminals. Real kernel interfaces without real wires; a scenario brings up the devices that its
// machine is bound to.
#pragma once

#include "drivers/camera/kind.hpp"
#include "drivers/can/kind.hpp"
#include "drivers/gpio/kind.hpp"
#include "kernel/machine/table/board.hpp"

namespace tappet::board {

inline constexpr Board bench{
    .name = "bench",
    .world = "bench",
    .memory_budget_bytes = 4 * 1024 * 1024,
    .heap_bytes = 160 * 1024,
    .processors = 1, // the emulator counts instructions for one processor only
    .highest_priority = 80,
    .devices = board_devices(
        board_device("can0", "can", "can0", bit_rate(1'000'000, 5'000'000)),
        board_device("can1", "can", "can1", bit_rate(1'000'000, 5'000'000)),
        board_device("can2", "can", "can2", bit_rate(500'000)), // as on 100 m cable
        board_device("io", "gpio", "/dev/io", lines(32)),
        board_device("panel", "gpio", "/dev/panel", lines(32)),
        // Linux's vivid, in guests that ask for it.
        board_device("camera0", "camera", "/dev/video0", frames(320, 180, 25), pixels(camera::Format::yuyv)),
        board_device("line", "serial", "/dev/line")), // a pseudo-terminal's end
    // The emulator has neither a frequency governor nor a clock that Linux trusts.
    .only_warned = warn_only("clock-source", "cpu-governor"),
    .kernel_command_line = "quiet panic=-1 sysctl.kernel.sched_rt_runtime_us=-1 cryptomgr.notests",
    // The image creates its CAN interfaces and lines itself: nothing of them leaves the guest.
    .image = {.modules = kernel_modules("nvme async_probe", "can-raw", "vcan", "gpio-sim",
                                        "i6300esb heartbeat=20", "ext4", "vfat", "nls_cp437", "nls_ascii"),
              .later_modules =
                  kernel_modules("xhci-pci", "usb-storage", "sd_mod", "button", "evdev", "e1000e"),
              .consoles = consoles("ttyS0"),
              .networks = networks(ethernet("eth0", "10.0.2.15/24")), // the network of the emulator
              .service_port = 4848},
    .properties_directory = "/run",
    // Everyone in the guest may read; two users of its tests may do more.
    .browsing = {.directory = "/run/tappet",
                 .mode = 0666,
                 .roles = roles(user(1001, Role::machine_operator), user(1002, Role::engineer))},
    .black_box_directory = "/run",
    .watchdog = "/dev/watchdog", // QEMU's i6300esb
};

} // namespace tappet::board

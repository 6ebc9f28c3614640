// SPDX-License-Identifier: Apache-2.0
// The bench: an emulated industrial PC with a real-time kernel, CAN interfaces and GPIO lines. It boots for
// one scenario, and is discarded afterwards. A scenario is a list of files, devices and commands; none of its
// state outlives the run.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::bench {

struct File {
    std::string host;  // a file, or a folder that is copied completely
    std::string guest; // absolute path
};

struct GpioChip {
    std::string name; // /dev/NAME in the guest
    unsigned lines = 0;
};

struct Setting {
    std::string path; // in the guest, for instance below /proc/sys
    std::string value;
};

// The clock of the guest. Instructions: guest time follows the executed instructions (2 ns each) and idle
// time is skipped, so the guest is a steady single-processor box of 500 million instructions per second on
// any host. Host: guest time is the host's, with several processors, and every delay of the host adds to the
// guest's latency.
enum class Clock { instructions, host };

struct Scenario {
    std::string kernel = "rt"; // or "rt-6.12", a later one, or "plain", without real-time
    Clock clock = Clock::instructions;
    unsigned processors = 1; // more than one only under the host's clock
    unsigned memory_mib = 256;
    std::string kernel_arguments;   // appended to the bench's own
    std::vector<File> files;        // dynamic programs include their libraries
    std::vector<std::string> tools; // programs of the host, by name, copied to /bin
    std::vector<std::string> can;   // virtual CAN interfaces, up
    // Emulated cards of two controllers, each pair on its own bus: "sja1000" for classical CAN, "ctucan" for
    // CAN FD. Linux's own drivers name the interfaces, which are down and have no bit rate.
    std::vector<std::string> can_cards;
    std::vector<GpioChip> gpio;
    bool camera = false;           // Linux's test camera, vivid: /dev/video0
    std::vector<Setting> settings; // written before the first command
    bool unthrottled = false;      // no kernel throttles real-time threads
    // In order; the first that fails ends the scenario. "& " at the end: in the background, terminated at the
    // end of the scenario. "- " in front: its exit code does not count. Steps of the bench itself: "@sleep
    // SECONDS",
    // "@write PATH TEXT", "@link NAME up|down", "@signal NAME SIGNAL", "@wait NAME" (the code of a background
    // command), "@wait NAME while OTHER" (the same, but when OTHER ends first, that has failed).
    std::vector<std::string> commands;
    std::vector<File> collect; // copied from the guest at the end, whatever the outcome
    double timeout_s = 120;    // of wall time, from the first command on
    std::string init;          // PID 1; empty: bench-init in the running program's folder
    bool keep = false;         // keep the working folder
};

/// Adds everything that a machine finds on the board "bench": its buses and lines, and unthrottled real-time
/// threads.
void add_board(Scenario& scenario);

struct Outcome {
    // The bench itself worked: it booted, ran every required step, and switched off.
    bool completed = false;
    bool cancelled = false; // by the caller
    int exit_code = -1;     // of the first command that failed, or 0
    std::string fault;      // what, where and cure, when not completed
    double boot_wall_s = 0; // power on to the first command
    double total_wall_s = 0;
};

using Output = std::function<void(std::string_view bytes)>;

// Called ten times a second and after every output; true ends the run at once, and nothing is collected.
using Cancelled = std::function<bool()>;

// Boots, runs, powers off. Passes the output of the guest's commands on as it comes.
Outcome run(const Scenario& scenario, const Output& output, const Cancelled& cancelled = {});

} // namespace tappet::bench

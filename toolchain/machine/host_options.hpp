// The options of every machine's host program; `tappet` reads them before it builds that program.
#pragma once

#include "toolchain/command_line.hpp"

#include <array>

namespace tappet {

/// Any other option belongs to the plant, and has a value.
inline constexpr std::array host_options{
    Option{"--virtual", "", "virtual time, deterministic: the default"},
    Option{"--real", "", "real time, with SCHED_FIFO threads"},
    Option{.name = "--seed",
           .value = "N",
           .help = "seed of the plant and of the faults of its wires (default 1)",
           .is_number = true},
    Option{.name = "--for",
           .value = "SECONDS",
           .help = "ends after SECONDS, or earlier when the plant is done (default: the plant's time)",
           .is_number = true,
           .least = 1,
           .most = 1'000'000'000}, // some thirty years
    Option{"--summary", "FILE", "writes what machine and plant counted, as JSON"},
    Option{"--properties", "DIR", "reads the components' properties there and saves them at the end"},
    Option{"--browse", "DIR",
           "opens a socket for tappet-browse in DIR (use --real: virtual time does not wait for browsers)"},
    Option{"--record-can", "DIR", "records each CAN bus in DIR, in the format of candump -L"},
    Option{"--replay-can", "BUS=FILE",
           "replaces the plant's frames on BUS by this candump log until the log ends; FILE@SECONDS: starts "
           "it after SECONDS"},
    Option{"--quiet", "", "hides what the machine's components print, but not faults"},
    Option{"--plan", "",
           "prints what the compiler derived from the table: priorities, order, mailboxes, memory"},
    Option{"--wires", "", "prints a value of each CAN signal and Modbus register with its bytes on the wire"},
    Option{"--help", "", "this text"}};

} // namespace tappet

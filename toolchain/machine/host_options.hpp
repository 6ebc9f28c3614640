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
           .help = "of the plant and of the faults of its wires (default 1)",
           .is_number = true},
    Option{.name = "--for",
           .value = "SECONDS",
           .help = "ends after so long, unless the plant is done before (default: what the plant says)",
           .is_number = true,
           .least = 1,
           .most = 1'000'000'000}, // some thirty years
    Option{"--summary", "FILE", "writes what machine and plant counted, as JSON"},
    Option{"--properties", "DIR", "reads the components' properties there and saves them at the end"},
    Option{"--browse", "DIR",
           "opens a socket for tappet-browse there (with --real: virtual time does not wait for it)"},
    Option{"--record-can", "DIR", "writes what is on each CAN bus there, as candump -L does"},
    Option{"--replay-can", "BUS=FILE",
           "plays that candump log in place of what the plant sends on the bus, up to its end; FILE@SECONDS: "
           "it begins so late"},
    Option{"--quiet", "", "what the machine's components print is not shown; faults are"},
    Option{"--plan", "", "what the compiler derived from the table: priorities, order, mailboxes, memory"},
    Option{"--help", "", "this text"}};

} // namespace tappet

// The options of every machine's host program, as it and the front door print them.
#pragma once

#include <string_view>

namespace tappet {

inline constexpr std::string_view host_usage =
    "  --virtual | --real  virtual time, deterministic (default), or real time with SCHED_FIFO threads\n"
    "  --seed N            of the plant and of the faults of its wires (default 1)\n"
    "  --for SECONDS       ends after so long, unless the plant is done before (default: what the plant "
    "says)\n"
    "  --summary FILE      writes what machine and plant counted, as JSON\n"
    "  --properties DIR    reads the components' properties there and saves them at the end\n"
    "  --browse DIR        opens a socket for tappet-browse there (with --real: virtual time does not wait "
    "for "
    "it)\n"
    "  --quiet             what the machine's components print is not shown; faults are\n"
    "  --plan              what the compiler derived from the table: priorities, order, mailboxes, memory\n"
    "  --help              this text\n";

} // namespace tappet

// The command line of the host's carpet loom.
#pragma once

#include "apps/carpet_loom/plant/settings.hpp"
#include "kernel/base/text.hpp"

#include <cstdint>
#include <expected>
#include <string_view>

namespace tappet::carpet {

struct Options {
    bool virtual_time = true;
    std::uint64_t seed = 1;
    std::uint64_t picks = 200;
    std::string_view summary;    ///< a file; empty: none
    std::string_view properties; ///< a directory; empty: they are not kept
    std::string_view browse;     ///< the directory of the browsers' socket; empty: none
    bool quiet = false;
    bool plan = false;
    bool help = false;
    loom::Settings plant{};
};

inline constexpr std::string_view usage =
    "carpet_loom: the carpet loom with its plant in one process\n"
    "  --world host        this program's only world; the bench's and the box's are programs of their own\n"
    "  --virtual | --real  virtual time, deterministic (default), or real time with SCHED_FIFO threads\n"
    "  --seed N            of the plant: inertia, brake, yarn, faults (default 1)\n"
    "  --picks M           ends after so many picks (default 200)\n"
    "  --weft-breaks N     one weft in N breaks, 0: none (default 40)\n"
    "  --warp-breaks N     one pick in N breaks a warp end, 0: none (default 150)\n"
    "  --emergency-stops N one pick in N ends in an emergency stop, 0: none (default 0)\n"
    "  --summary FILE      writes the summary as JSON\n"
    "  --properties DIR    reads the components' properties from there and saves them at the end\n"
    "  --browse DIR        opens a socket for tappet-browse there (with --real: virtual time does not wait "
    "for it)\n"
    "  --quiet             no status lines\n"
    "  --plan              what the compiler derived from the table: priorities, order, mailboxes, memory\n";

/// An error names the option and the cure.
std::expected<Options, Sentence> parse_options(int count, const char* const* words);

} // namespace tappet::carpet

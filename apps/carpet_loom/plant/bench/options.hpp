// The command line of the bench's plant program.
#pragma once

#include "apps/carpet_loom/plant/settings.hpp"

#include <expected>
#include <string>

namespace tappet::loom {

/// Something that happens to a wire, not to the loom: at a time, for a while.
struct Outage {
    Duration at = Duration::max();
    Duration lasts{};
};

struct Options {
    Settings settings{};
    std::uint64_t seed = 1;
    std::string can = "can0";
    std::string gpio_chip;  // folder with sim_gpio<n>/pull and sim_gpio<n>/value; empty: no lines
    int modbus_port = 1502; // 0: no Modbus
    std::string modbus_address = "127.0.0.1";
    std::uint64_t picks = 0; // ends by itself when they are woven and the loom stands; 0: at SIGTERM
    /// It ends not before USR1 came, and then so many picks later at least; 0: nobody sends it.
    std::uint64_t picks_after_usr1 = 0;
    std::string report;                       // file; empty: standard output
    Duration period = 200us;                  // polling of the lines
    int fifo_priority = 0;                    // 0: not real-time
    Outage modbus_stop{};                     // the server is gone
    Duration bus_off_at = Duration::max();    // an error frame tells every listener of a bus-off
    Duration edge_burst_at = Duration::max(); // the weft detector's line flutters
    Duration die_at = Duration::max();        // killed, without a report
    bool help = false;
};

[[nodiscard]] std::expected<Options, std::string> parse_options(int count, const char* const* words);
[[nodiscard]] const char* usage();

} // namespace tappet::loom

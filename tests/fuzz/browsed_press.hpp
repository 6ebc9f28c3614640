// A press under virtual time that browsers ask for anything, and what must hold of it then.
#pragma once

#include "tests/kernel/services/browsing/press_machine.hpp"

#include "kernel/machine/accept.hpp"
#include "kernel/os/local_socket.hpp"
#include "kernel/services/configuration/property_files.hpp"

#include <cstdlib>
#include <string>

#include <unistd.h>

namespace tappet::press {

inline void demand(bool holds) {
    if (!holds) std::abort();
}

template <const auto& machine_table> struct BrowsedPress {
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{AtRunTime<machine_table, board>::machine(), clock};
    VirtualWorld world{instance};
    PropertyFiles files{{}}; // none are kept

    /// It starts, and answers in a folder.
    explicit BrowsedPress(const std::string& folder) {
        instance.read_properties_from(files.store());
        instance.browse_in(folder);
        demand(instance.configure({}).has_value());
        world.start();
    }
    ~BrowsedPress() { instance.template find<BrowserService>("browser")->finalise(); }
    BrowsedPress(const BrowsedPress&) = delete;
    BrowsedPress& operator=(const BrowsedPress&) = delete;

    void run(Duration time) { demand(world.run_until(clock.now() + time)); }
    /// No property leaves what its component accepts, and the count of forced ports is right.
    void check() {
        const auto& ram = *instance.template find<Ram>("ram");
        demand(ram.speed.get() * ram.force.get() <= 100);
        std::uint32_t forced = 0;
        const auto view = map::View::open(instance.observation().shared_memory());
        demand(view.has_value());
        for (const map::Facet& each : view->facets()) forced += view->word<std::uint8_t>(each.forced_at) != 0;
        demand(forced == instance.observation().forced_ports().load());
    }
};

} // namespace tappet::press

// A press under virtual time that answers any requests of browsers, and the invariants that must hold
// afterwards.
#pragma once

#include "tests/kernel/services/browsing/press_machine.hpp"

#include "kernel/machine/accept.hpp"
#include "kernel/os/local_socket.hpp"
#include "kernel/services/configuration/property_files.hpp"
#include "tests/fuzz/input.hpp"

#include <array>
#include <optional>
#include <string>

namespace tappet::press {

using fuzz::demand;

/// Reads its answers, each packet one object.
struct Browser {
    std::optional<os::LocalConnection> connection;
    std::string last{};

    void connect(const std::string& path) {
        if (auto made = os::LocalConnection::connect(path.c_str())) connection.emplace(std::move(*made));
    }
    /// Returns the number of packets that have come.
    std::size_t hear() {
        static std::array<char, browsing::max_packet_bytes + 1> room;
        for (std::size_t packets = 0;; ++packets) {
            if (!connection) return packets;
            const auto received = connection->receive(room);
            if (received.what == os::LocalConnection::Received::What::closed) connection.reset();
            if (received.what != os::LocalConnection::Received::What::packet) return packets;
            demand(received.bytes > 2 && room[0] == '{' && room[received.bytes - 1] == '\n');
            last.assign(room.data(), received.bytes);
        }
    }
};

/// Removes and returns the first line.
inline std::string_view next_line(std::string_view& lines) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    const std::string_view line = lines.substr(0, end);
    lines.remove_prefix(std::min(end + 1, lines.size()));
    return line;
}

template <const auto& machine_table> struct BrowsedPress {
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{AtRunTime<machine_table, board>::machine(), clock};
    VirtualWorld world{instance};
    PropertyFiles files{{}}; // no file is kept

    /// Starts, and answers in a folder.
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
    /// Demands that each property is within the limits of its component and that the count of forced ports is
    /// right.
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

// Any bytes as requests of a browser: each line one packet into a machine under virtual time. Whatever comes,
// every packet is answered, no property leaves what its component accepts, and the count of forced ports is
// right.
#include "tests/kernel/services/browsing/press_machine.hpp"

#include "kernel/machine/firmware.hpp"
#include "kernel/os/local_socket.hpp"
#include "kernel/services/configuration/property_files.hpp"

#include <array>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include <unistd.h>

namespace {

using namespace tappet;

void demand(bool holds) {
    if (!holds) std::abort();
}

struct Rig {
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{Firmware<press::table, press::board>::machine(), clock};
    VirtualWorld world{instance};
    PropertyFiles files{{}}; // none are kept
    Rig() { instance.read_properties_from(files.store()); }
};

std::size_t read_all(const os::LocalConnection& client) {
    static std::array<char, browsing::max_packet_bytes + 1> room;
    std::size_t packets = 0;
    while (true) {
        const auto received = client.receive(room);
        if (received.what != os::LocalConnection::Received::What::packet) return packets;
        demand(received.bytes > 2 && room[0] == '{' && room[received.bytes - 1] == '\n');
        ++packets;
    }
}

void check(Rig& rig) {
    const auto& ram = *rig.instance.find<press::Ram>("ram");
    demand(ram.speed.get() * ram.force.get() <= 100);
    std::uint32_t forced = 0;
    const auto view = map::View::open(rig.instance.observation().shared_memory());
    demand(view.has_value());
    for (const map::Facet& each : view->facets()) forced += view->word<std::uint8_t>(each.forced_at) != 0;
    demand(forced == rig.instance.observation().forced_ports().load());
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string directory = "/tmp/tappet-request-fuzz-" + std::to_string(getpid());
    static const std::string path = directory + "/press.socket";
    static std::optional<Rig> rig;
    rig.emplace();
    rig->instance.browse_in(directory);
    demand(rig->instance.configure({}).has_value());
    rig->world.start();
    const auto client = os::LocalConnection::connect(path.c_str());
    demand(client.has_value());
    std::string_view rest{reinterpret_cast<const char*>(data), size};
    Time now{};
    for (int packets = 0; !rest.empty() && packets < 16; ++packets) {
        const std::size_t end = rest.find('\n');
        const std::string_view packet = rest.substr(0, end);
        rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
        if (packet.empty()) continue; // an empty packet reads like the end of the connection
        demand(client->send(packet) == os::LocalConnection::Sent::sent);
        now += 60ms;
        demand(rig->world.run_until(now));
        std::size_t answers = read_all(*client);
        // What an engine that was stopped is asked for, is given up in the end.
        for (int waits = 0; answers == 0 && waits < 60; ++waits) {
            now += 50ms;
            demand(rig->world.run_until(now));
            answers = read_all(*client);
        }
        demand(answers != 0);
        check(*rig);
    }
    rig->instance.find<BrowserService>("browser")->finalise();
    return 0;
}

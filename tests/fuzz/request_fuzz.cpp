// Any bytes as requests of a browser: each line one packet into a machine under virtual time. Whatever comes,
// every packet is answered, no property leaves what its component accepts, and the count of forced ports is
// right.
#include "tests/fuzz/browsed_press.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <unistd.h>

namespace {

using namespace tappet;
using press::demand;

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

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string directory = "/tmp/tappet-request-fuzz-" + std::to_string(getpid());
    static const std::string path = directory + "/press.socket";
    static std::optional<press::BrowsedPress<press::table>> rig;
    rig.emplace(directory);
    const auto client = os::LocalConnection::connect(path.c_str());
    demand(client.has_value());
    std::string_view rest{reinterpret_cast<const char*>(data), size};
    for (int packets = 0; !rest.empty() && packets < 16; ++packets) {
        const std::size_t end = rest.find('\n');
        const std::string_view packet = rest.substr(0, end);
        rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
        if (packet.empty()) continue; // an empty packet reads like the end of the connection
        demand(client->send(packet) == os::LocalConnection::Sent::sent);
        rig->run(60ms);
        std::size_t answers = read_all(*client);
        // What an engine that was stopped is asked for, is given up in the end.
        for (int waits = 0; answers == 0 && waits < 60; ++waits) {
            rig->run(50ms);
            answers = read_all(*client);
        }
        demand(answers != 0);
        rig->check();
    }
    rig.reset();
    return 0;
}

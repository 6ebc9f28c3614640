// Any bytes as requests of a browser: each line is one packet to a machine under virtual time. The machine
// answers every packet, each property stays within the limits of its component, and the count of forced ports
// is right.
#include "tests/fuzz/browsed_press.hpp"

#include <unistd.h>

namespace {

using namespace tappet;
using press::demand;

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string directory = "/tmp/tappet-request-fuzz-" + std::to_string(getpid());
    static const std::string path = directory + "/press.socket";
    static std::optional<press::BrowsedPress<press::table>> rig;
    rig.emplace(directory);
    press::Browser client;
    client.connect(path);
    std::string_view rest{reinterpret_cast<const char*>(data), size};
    for (int packets = 0; !rest.empty() && packets < 16; ++packets) {
        const std::string_view packet = press::next_line(rest);
        if (packet.empty()) continue; // an empty packet reads like the end of the connection
        demand(client.connection && client.connection->send(packet) == os::LocalConnection::Sent::sent);
        rig->run(60ms);
        std::size_t answers = client.hear();
        // A stopped engine gives up pending requests in the end.
        for (int waits = 0; answers == 0 && waits < 60; ++waits) {
            rig->run(50ms);
            answers = client.hear();
        }
        demand(answers != 0);
        rig->check();
    }
    rig.reset();
    return 0;
}

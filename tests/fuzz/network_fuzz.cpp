// Any bytes at the gateway's port: HTTP requests, logins, the upgrade, and the frames of a WebSocket behind
// it. The connection ends when the client's end does, and gives its place back; what it answers begins as
// HTTP.
#include "toolchain/tools/gateway/server.hpp"

#include "tests/fuzz/input.hpp"

#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

#include <array>
#include <string>

#include <stdlib.h>
#include <unistd.h>

namespace {

using namespace tappet::network;
using tappet::fuzz::demand;
namespace net = boost::asio;

/// A gateway with one user, whose password costs little to check.
struct Gate {
    Gate() : hub{access(), {}, outside()}, server{io, hub, nullptr} {
        demand(server.listen("127.0.0.1", 0).empty());
    }
    static Access access() {
        Users users;
        User mary{"mary", tappet::Role::engineer, Cost{2, 1, 1}, std::string(16, 's'), {}};
        mary.hash = scrypt("a long password", mary.salt, mary.cost);
        users.put(mary);
        return Access{"/nowhere", users};
    }
    static Outside outside() {
        Outside made;
        made.connect = [](const std::string&, const OnPacket&, std::string& fault) {
            fault = "there is none";
            return std::unique_ptr<Relay>{};
        };
        made.in_background = [](const std::function<bool()>& work, const std::function<void(bool)>& done) {
            done(work());
            return true;
        };
        return made;
    }
    Hub hub;
    net::io_context io{1};
    Server server;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static Gate gate;
    net::io_context mine;
    net::ip::tcp::socket client{mine};
    client.connect({net::ip::make_address("127.0.0.1"), gate.server.port()});
    boost::system::error_code error;
    const auto serve = [&] {
        while (gate.io.poll() != 0) {
        }
    };
    serve();
    demand(gate.hub.counters().connections == 1);
    // Larger inputs than the kernel's buffers hold would wait for a reader.
    net::write(client, net::buffer(data, std::min<std::size_t>(size, 32 * 1024)), error);
    client.shutdown(net::ip::tcp::socket::shutdown_send, error);
    std::string answer;
    std::array<char, 4096> part{};
    client.non_blocking(true);
    for (int idle = 0; gate.hub.counters().connections != 0;) {
        serve();
        const std::size_t count = client.read_some(net::buffer(part), error);
        answer.append(part.data(), count);
        if (count != 0 || (error && error != net::error::would_block)) idle = 0;
        demand(++idle < 2000);
        if (idle > 10) ::usleep(1000);
    }
    for (;;) {
        const std::size_t count = client.read_some(net::buffer(part), error);
        if (count == 0) break;
        answer.append(part.data(), count);
    }
    demand(answer.empty() || answer.starts_with("HTTP/1.1 "));
    return 0;
}

// Numbers requests, and matches each packet to the request that waits for it.
#include "toolchain/machine/swarm_browser.hpp"

#include "kernel/services/browsing/protocol.hpp"

#include <array>
#include <charconv>
#include <utility>

#include <sys/syscall.h>
#include <unistd.h>

namespace tappet {

std::string field_of(std::string_view packet, std::string_view name) {
    const std::string key = "\"" + std::string{name} + "\": ";
    const std::size_t at = packet.find(key);
    if (at == packet.npos) return {};
    std::string_view rest = packet.substr(at + key.size());
    if (!rest.starts_with('"')) return std::string{rest.substr(0, rest.find_first_of(",}"))};
    std::string text;
    for (rest.remove_prefix(1); !rest.empty() && rest.front() != '"'; rest.remove_prefix(1)) {
        if (rest.front() == '\\') rest.remove_prefix(1);
        text += rest.substr(0, 1);
    }
    return text;
}

bool is_good(std::string_view answer) { return field_of(answer, "ok") == "true"; }

void SwarmBrowser::ask(std::string request, Time now, Then then) {
    const std::string packet = std::to_string(++number_) + " " + request;
    if (connection_.open() && connection_.send(packet) == os::LocalConnection::Sent::sent)
        asked_[number_] = {now, std::move(request), std::move(then)};
    else
        then({});
}

bool SwarmBrowser::hear() {
    if (!connection_.open()) {
        // The machine reads this thread's user when it connects.
        const std::uint32_t own = os::own_user();
        const bool becomes = user_ != own && ::syscall(SYS_setresuid, -1, user_, -1) == 0;
        auto connected = os::LocalConnection::connect(socket_.c_str());
        if (becomes) static_cast<void>(::syscall(SYS_setresuid, -1, own, -1));
        if (!connected) return false;
        connection_ = std::move(*connected);
        ++connections_;
    }
    std::array<char, browsing::max_packet_bytes + 64> room;
    for (;;) {
        const auto received = connection_.receive(room);
        if (received.what == os::LocalConnection::Received::What::nothing) return true;
        if (received.what == os::LocalConnection::Received::What::closed) break;
        take({room.data(), received.bytes});
    }
    leave();
    return false;
}

void SwarmBrowser::take(std::string_view packet) {
    std::uint32_t number = 0;
    const std::string id = field_of(packet, "id");
    std::from_chars(id.data(), id.data() + id.size(), number);
    const auto found = asked_.find(number);
    if (found == asked_.end() || field_of(packet, "ok").empty()) {
        if (tell_) tell_(packet);
        return;
    }
    const Then then = std::move(found->second.then);
    asked_.erase(found);
    then(packet);
}

void SwarmBrowser::leave() {
    connection_.close();
    for (const auto& [number, asked] : std::exchange(asked_, {})) asked.then({});
}

} // namespace tappet

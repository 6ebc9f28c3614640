// Lets clients in, hears them, and loses nothing of the machine's time on one that does not listen.
#include "kernel/services/browsing/door.hpp"

#include "kernel/services/browsing/reply.hpp"

namespace tappet::browsing {

std::expected<void, Sentence> Door::open(std::string_view directory, std::string_view machine,
                                         const BoardBrowsing& board) noexcept {
    board_ = board;
    const Sentence path{directory, "/", machine, socket_suffix};
    return listener_.listen(path.view(), board.mode, board.group);
}

void Door::close() noexcept {
    for (Client& each : clients_) dismiss(each);
    listener_.close();
}

Client* Door::welcome() noexcept {
    os::LocalConnection connection = listener_.accept();
    if (!connection.open()) return nullptr;
    const auto peer = connection.peer();
    for (Client& each : clients_) {
        if (each.serial != 0 || !peer) continue;
        each.connection = std::move(connection);
        each.peer = *peer;
        each.role = role_of(*peer, board_);
        each.serial = ++serials_;
        each.dropped = each.told_dropped = 0;
        return &each;
    }
    ++turned_away_;
    Reply reply{0, Refusal::not_now,
                Sentence{"all ", max_clients, " places are taken; end another browser of this machine"}};
    static_cast<void>(connection.send(reply.finish()));
    return nullptr;
}

Client* Door::find(std::uint64_t serial) noexcept {
    for (Client& each : clients_)
        if (each.serial == serial && serial != 0) return &each;
    return nullptr;
}

std::optional<std::string_view> Door::receive(Client& client, std::span<char> into, bool& cut) noexcept {
    using What = os::LocalConnection::Received::What;
    if (client.serial == 0) return std::nullopt;
    const auto received = client.connection.receive(into);
    if (received.what == What::closed) dismiss(client);
    if (received.what != What::packet) return std::nullopt;
    cut = received.cut;
    return std::string_view{into.data(), received.bytes};
}

bool Door::send(Client& client, std::string_view packet, int descriptor) noexcept {
    std::array<char, max_packet_bytes + 64> noted;
    if (client.dropped != client.told_dropped && packet.ends_with("}\n")) {
        JsonText text{noted};
        text.raw(packet.substr(0, packet.size() - 2)).raw(", ");
        text.field("dropped", client.dropped).raw("}\n");
        if (text.size() != 0) packet = text.view();
    }
    switch (client.connection.send(packet, descriptor)) {
    case os::LocalConnection::Sent::sent: client.told_dropped = client.dropped; return true;
    case os::LocalConnection::Sent::full: ++client.dropped; return false;
    case os::LocalConnection::Sent::closed: dismiss(client); return false;
    }
    return false;
}

void Door::dismiss(Client& client) noexcept {
    client.connection.close();
    client.serial = 0;
}

} // namespace tappet::browsing

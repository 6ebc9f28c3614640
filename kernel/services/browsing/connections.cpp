// Accepts clients and receives their packets; a client that does not read costs the machine no time.
#include "kernel/services/browsing/connections.hpp"

#include "kernel/services/browsing/reply.hpp"

namespace tappet::browsing {

std::expected<void, Sentence> Connections::open(std::string_view directory, std::string_view machine,
                                                const BoardBrowsing& board) noexcept {
    board_ = board;
    const Sentence path{directory, "/", machine, socket_suffix};
    return listener_.listen(path.view(), board.mode, board.group);
}

void Connections::close() noexcept {
    for (Client& each : clients_) disconnect(each);
    listener_.close();
}

Client* Connections::accept() noexcept {
    for (std::size_t i = 0; i < most_each_cycle; ++i) {
        os::LocalConnection connection = listener_.accept();
        if (!connection.open()) return nullptr;
        const auto peer = connection.peer();
        if (!peer) continue; // it has already left
        // A gateway that has not named its user yet takes nobody's place.
        const BoardRole* const gateway = gateway_of(*peer, board_);
        const Role role = gateway != nullptr ? Role::observer : role_of(*peer, board_);
        Client* place = place_for(role, gateway);
        if (place == nullptr) {
            turn_away(connection, Sentence{"all ", max_clients,
                                           " places are taken; end another browser of this machine"});
            continue;
        }
        if (place->serial != 0) {
            const Sentence who = gateway != nullptr ? Sentence{"another user of your gateway"}
                                                    : Sentence{"an ", to_text(role)};
            turn_away(place->connection, Sentence{who, " needs this place; connect again later"});
            disconnect(*place);
        }
        *place = Client{.connection = std::move(connection),
                        .peer = *peer,
                        .rights = {role},
                        .serial = ++serials_,
                        .gateway = gateway,
                        .must_name_user = gateway != nullptr,
                        .heard = ++heard_};
        return place;
    }
    return nullptr;
}

/// Returns a free place, or that of a client with a lower role. The role of a gateway's user is not known
/// yet: it may be higher than that of the gateway's own observers, which must not block it.
Client* Connections::place_for(Role role, const BoardRole* gateway) noexcept {
    Client* best = nullptr;
    for (Client& each : clients_) {
        if (each.serial == 0) return &each;
        const bool is_own = gateway != nullptr && each.gateway == gateway;
        if (each.rights.role >= role && !(is_own && each.rights.role == Role::observer)) continue;
        if (best == nullptr || each.rights.role < best->rights.role ||
            (each.rights.role == best->rights.role && each.heard < best->heard))
            best = &each;
    }
    return best;
}

void Connections::turn_away(const os::LocalConnection& connection, const Sentence& why) noexcept {
    ++turned_away_;
    Reply reply{0, Refusal::not_now, why};
    static_cast<void>(connection.send(reply.finish())); // disconnect even a client that does not read it
}

Client* Connections::find(std::uint64_t serial) noexcept {
    for (Client& each : clients_)
        if (each.serial == serial && serial != 0) return &each;
    return nullptr;
}

std::optional<std::string_view> Connections::receive(Client& client, std::span<char> into,
                                                     bool& cut) noexcept {
    using What = os::LocalConnection::Received::What;
    if (client.serial == 0) return std::nullopt;
    const auto received = client.connection.receive(into);
    if (received.what == What::closed) disconnect(client);
    if (received.what != What::packet) return std::nullopt;
    client.heard = ++heard_;
    cut = received.cut;
    return std::string_view{into.data(), received.bytes};
}

bool Connections::send(Client& client, std::string_view packet, int descriptor) noexcept {
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
    case os::LocalConnection::Sent::closed: disconnect(client); return false;
    }
    return false;
}

void Connections::disconnect(Client& client) noexcept {
    client.connection.close();
    client.serial = 0;
}

} // namespace tappet::browsing

// The socket and its clients: at most max_clients; each may send a few packets a cycle.
#pragma once

#include "kernel/services/browsing/access.hpp"
#include "kernel/services/browsing/protocol.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace tappet::browsing {

/// One connection. `serial` is never reused: answers to a client that left reach nobody.
struct Client {
    os::LocalConnection connection{};
    os::Peer peer{};
    Rights rights{Role::observer};
    std::uint64_t serial = 0;           ///< 0: the place is free
    UserName user{};                    ///< for whom it asks; empty: for itself
    const BoardRole* gateway = nullptr; ///< the row that makes it a gateway
    bool has_asked = false;             ///< too late for `as`
    bool must_name_user = false;        ///< nothing but `hello` is answered before `as`
    std::uint64_t heard = 0; ///< increases with each packet of any client: the lowest is the longest idle
    std::uint64_t dropped = 0;
    std::uint64_t told_dropped = 0;
};

/// No function blocks; not real-time.
class Connections {
public:
    /// A client's packets in a cycle; further ones wait in its own socket.
    static constexpr std::size_t packets_each_cycle = 4;
    /// The most clients accepted in a cycle; more than its listener's queue holds.
    static constexpr std::size_t most_each_cycle = 16;

    std::expected<void, Sentence> open(std::string_view directory, std::string_view machine,
                                       const BoardBrowsing& board) noexcept;
    void close() noexcept;
    [[nodiscard]] bool is_open() const noexcept { return listener_.open(); }

    /// Accepts a waiting client. When all places are taken, a client with a higher role gets the place of the
    /// longest idle client of the lowest role, and a gateway's that of its own observer; a client that loses
    /// its place, or gets none, is told so and disconnected: `turned_away` counts them.
    [[nodiscard]] Client* accept() noexcept;
    [[nodiscard]] std::uint64_t turned_away() const noexcept { return turned_away_; }

    [[nodiscard]] std::array<Client, max_clients>& clients() noexcept { return clients_; }
    [[nodiscard]] Client* find(std::uint64_t serial) noexcept;
    /// Returns the next packet; nothing when none waits. A client that has left frees its place.
    [[nodiscard]] std::optional<std::string_view> receive(Client& client, std::span<char> into,
                                                          bool& cut) noexcept;
    /// Sends a packet. Returns false when the other end has no room: the packet is dropped and counted.
    bool send(Client& client, std::string_view packet, int descriptor = -1) noexcept;
    void disconnect(Client& client) noexcept;

private:
    [[nodiscard]] Client* place_for(Role role, const BoardRole* gateway) noexcept;
    void turn_away(const os::LocalConnection& connection, const Sentence& why) noexcept;

    os::LocalListener listener_{};
    BoardBrowsing board_{};
    std::array<Client, max_clients> clients_{};
    std::uint64_t serials_ = 0;
    std::uint64_t heard_ = 0;
    std::uint64_t turned_away_ = 0;
};

} // namespace tappet::browsing

// The socket and the clients that came through it: at most max_clients, each of whom is heard a few times a
// cycle.
#pragma once

#include "kernel/services/browsing/access.hpp"
#include "kernel/services/browsing/protocol.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace tappet::browsing {

/// One connection. `serial` never comes again: what was asked for by a client that left finds nobody.
struct Client {
    os::LocalConnection connection{};
    os::Peer peer{};
    Role role = Role::observer;
    std::uint64_t serial = 0; ///< 0: the place is free
    std::uint64_t heard = 0;  ///< rises with each packet of anybody: the lowest is the longest idle
    std::uint64_t dropped = 0;
    std::uint64_t told_dropped = 0;
};

/// Nothing of it blocks; not real-time.
class Connections {
public:
    /// What a client gets of a cycle's time; the rest waits in its own socket.
    static constexpr std::size_t packets_each_cycle = 4;
    /// Of those who wait to be accepted; more than its listener lets wait.
    static constexpr std::size_t most_each_cycle = 16;

    std::expected<void, Sentence> open(std::string_view directory, std::string_view machine,
                                       const BoardBrowsing& board) noexcept;
    void close() noexcept;
    [[nodiscard]] bool is_open() const noexcept { return listener_.open(); }

    /// Someone who wants in and is let in. When all places are taken, one of a higher role gets the place of
    /// the longest idle of the lowest; whoever loses a place, or gets none, is told so and let go:
    /// `turned_away` counts them.
    [[nodiscard]] Client* accept() noexcept;
    [[nodiscard]] std::uint64_t turned_away() const noexcept { return turned_away_; }

    [[nodiscard]] std::array<Client, max_clients>& clients() noexcept { return clients_; }
    [[nodiscard]] Client* find(std::uint64_t serial) noexcept;
    /// The next packet; nothing when none waits. A client that is gone leaves its place.
    [[nodiscard]] std::optional<std::string_view> receive(Client& client, std::span<char> into,
                                                          bool& cut) noexcept;
    /// A packet that finds no room at the other end is dropped, and counted. False then.
    bool send(Client& client, std::string_view packet, int descriptor = -1) noexcept;
    void disconnect(Client& client) noexcept;

private:
    [[nodiscard]] Client* place_for(Role role) noexcept;
    void turn_away(const os::LocalConnection& connection, const Sentence& why) noexcept;

    os::LocalListener listener_{};
    BoardBrowsing board_{};
    std::array<Client, max_clients> clients_{};
    std::uint64_t serials_ = 0;
    std::uint64_t heard_ = 0;
    std::uint64_t turned_away_ = 0;
};

} // namespace tappet::browsing

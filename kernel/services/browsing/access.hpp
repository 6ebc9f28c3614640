// Access rights (thesis 4.8): the role of a peer, from its credentials and the board's list; and the users
// for whom a gateway asks.
#pragma once

#include "kernel/base/bounded_text.hpp"
#include "kernel/machine/table/board.hpp"
#include "kernel/os/local_socket.hpp"

namespace tappet::browsing {

/// The longest name of a user for whom a connection asks.
inline constexpr std::size_t max_user_characters = 32;
using UserName = Text<max_user_characters>;

constexpr bool means(const BoardPeer& row, const os::Peer& peer) noexcept {
    return row.is_group ? peer.is_in(row.number) : peer.user == row.number;
}

/// Returns the row that makes the peer a gateway, of several the one with the lowest bound; null: none.
inline const BoardRole* gateway_of(const os::Peer& peer, const BoardBrowsing& board) noexcept {
    const BoardRole* found = nullptr;
    for (const BoardRole& row : board.roles)
        if (row.is_gateway && means(row.peer, peer) && (found == nullptr || row.role < found->role))
            found = &row;
    return found;
}

/// Returns the highest role that the board's rows give the peer. Root and the user that runs the machine are
/// engineers; any other user who may open the socket is an observer. A gateway's role is its bound.
inline Role role_of(const os::Peer& peer, const BoardBrowsing& board) noexcept {
    if (const BoardRole* const gateway = gateway_of(peer, board)) return gateway->role;
    Role role = Role::observer;
    if (peer.user == 0 || peer.user == os::own_user()) role = Role::engineer;
    for (const BoardRole& row : board.roles)
        if (means(row.peer, peer) && row.role > role) role = row.role;
    return role;
}

/// Reads the arguments of `as`. An answer that is not empty states the fault.
inline Sentence parse_user(std::string_view name, std::string_view role, std::string_view origin,
                           UserName& user, Rights& rights) noexcept {
    for (const char each : name)
        if (!((each >= 'a' && each <= 'z') || (each >= '0' && each <= '9') || each == '.' || each == '_' ||
              each == '-'))
            name = {};
    if (name.empty() || !user.assign(name))
        return Sentence{"a user's name has 1 to ", max_user_characters,
                        " characters of a-z, 0-9, '.', '_' and '-'; rename the user"};
    for (const Role each : {Role::observer, Role::machine_operator, Role::engineer})
        if (role == to_text(each)) rights = {each, origin == "panel" ? Origin::panel : Origin::network};
    if (role != to_text(rights.role))
        return Sentence{"there is no such role; write observer, operator or engineer"};
    if (origin != to_text(rights.origin))
        return Sentence{"a request comes from the network or from the panel; write network or panel"};
    return {};
}

} // namespace tappet::browsing

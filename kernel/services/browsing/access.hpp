// Access rights (thesis 4.8): the role of a peer, from its credentials and the board's list.
#pragma once

#include "kernel/machine/table/board.hpp"
#include "kernel/os/local_socket.hpp"

namespace tappet::browsing {

/// Returns the highest role that the board's rows give the peer. Root and the user that runs the machine are
/// engineers; any other user who may open the socket is an observer.
inline Role role_of(const os::Peer& peer, const BoardBrowsing& board) noexcept {
    Role role = Role::observer;
    if (peer.user == 0 || peer.user == os::own_user()) role = Role::engineer;
    for (const BoardRole& row : board.roles) {
        const bool meant = row.is_group ? peer.is_in(row.number) : peer.user == row.number;
        if (meant && row.role > role) role = row.role;
    }
    return role;
}

} // namespace tappet::browsing

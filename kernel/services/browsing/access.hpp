// Who may do what (thesis 4.8): the role of a peer, from its credentials and the board's list.
#pragma once

#include "kernel/machine/table/board.hpp"
#include "kernel/os/local_socket.hpp"

namespace tappet::browsing {

/// The highest role that a row of the board gives the peer. Root and the user that runs the machine are
/// engineers; whoever else may open the socket, observers.
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

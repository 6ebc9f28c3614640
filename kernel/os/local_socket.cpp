// AF_UNIX sockets without blocking.
#include "kernel/os/local_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#if !defined(SO_PEERGROUPS)
#define SO_PEERGROUPS 59
#endif

namespace tappet::os {

namespace {

sockaddr_un address_of(const char* path) noexcept {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path, strnlen(path, sizeof address.sun_path - 1));
    return address;
}

int new_socket() noexcept { return socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0); }

bool connect_to(int descriptor, const sockaddr_un& address) noexcept {
    return ::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

} // namespace

std::uint32_t own_user() noexcept { return geteuid(); }
std::int32_t own_process() noexcept { return getpid(); }

std::expected<LocalConnection, Sentence> LocalConnection::connect(const char* path) noexcept {
    LocalConnection connection{new_socket()};
    if (connection.open() && connect_to(connection.descriptor_, address_of(path))) return connection;
    const int error = errno;
    return std::unexpected(Sentence{"nothing answers at \"", std::string_view{path}, "\" (",
                                    std::strerror(error), "); ",
                                    error == EACCES   ? "ask for the group that the socket's file permits"
                                    : error == EAGAIN ? "all its places are taken: end another browser"
                                                      : "start the machine, or name its socket"});
}

void LocalConnection::close() noexcept {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
}

std::optional<Peer> LocalConnection::peer() const noexcept {
    ucred credentials{};
    socklen_t length = sizeof credentials;
    if (getsockopt(descriptor_, SOL_SOCKET, SO_PEERCRED, &credentials, &length) != 0) return std::nullopt;
    Peer peer{credentials.pid, credentials.uid, credentials.gid, {}};
    gid_t groups[decltype(peer.groups)::capacity()] = {};
    length = sizeof groups;
    if (getsockopt(descriptor_, SOL_SOCKET, SO_PEERGROUPS, groups, &length) == 0)
        for (std::size_t i = 0; i < length / sizeof groups[0]; ++i)
            static_cast<void>(peer.groups.push(groups[i]));
    return peer;
}

LocalConnection::Sent LocalConnection::send(std::string_view packet, int passed) const noexcept {
    iovec piece{const_cast<char*>(packet.data()), packet.size()};
    msghdr message{};
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof passed)] = {};
    if (passed >= 0) {
        message.msg_control = control;
        message.msg_controllen = sizeof control;
        cmsghdr* header = CMSG_FIRSTHDR(&message);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof passed);
        std::memcpy(CMSG_DATA(header), &passed, sizeof passed);
    }
    while (true) {
        if (sendmsg(descriptor_, &message, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0) return Sent::sent;
        if (errno == EINTR) continue;
        return errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS ? Sent::full : Sent::closed;
    }
}

LocalConnection::Received LocalConnection::receive(std::span<char> into, Passed passed) const noexcept {
    iovec piece{into.data(), into.size()};
    msghdr message{};
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    // The kernel itself closes descriptors without room here: there is none, or room for exactly one.
    // (CMSG_SPACE would pad that to two.)
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
    if (passed == Passed::one) {
        message.msg_control = control;
        message.msg_controllen = CMSG_LEN(sizeof(int));
    }
    ssize_t got = 0;
    do got = recvmsg(descriptor_, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    while (got < 0 && errno == EINTR);
    Received received;
    if (got < 0) {
        const bool later = errno == EAGAIN || errno == EWOULDBLOCK;
        received.what = later ? Received::What::nothing : Received::What::closed;
        return received;
    }
    if (const cmsghdr* header = CMSG_FIRSTHDR(&message);
        header != nullptr && header->cmsg_level == SOL_SOCKET && header->cmsg_type == SCM_RIGHTS)
        std::memcpy(&received.passed, CMSG_DATA(header), sizeof received.passed);
    // The end of a connection looks like an empty packet; nobody here sends one.
    received.what = got == 0 ? Received::What::closed : Received::What::packet;
    if (got == 0 && received.passed >= 0) ::close(std::exchange(received.passed, -1));
    received.bytes = std::min(static_cast<std::size_t>(got), into.size());
    received.cut = (message.msg_flags & MSG_TRUNC) != 0;
    return received;
}

bool LocalConnection::wait(int milliseconds) const noexcept {
    pollfd polled{descriptor_, POLLIN, 0};
    return poll(&polled, 1, milliseconds) > 0;
}

std::expected<void, Sentence> LocalListener::listen(std::string_view path, unsigned mode,
                                                    std::int64_t group) noexcept {
    close();
    if (path.size() >= sizeof path_)
        return std::unexpected(Sentence{"the socket's path \"", path,
                                        "\" has more than 107 characters; use a shorter directory"});
    std::copy(path.begin(), path.end(), path_);
    path_[path.size()] = '\0';
    const auto refused = [&](std::string_view cure) {
        const int error = errno;
        if (descriptor_ >= 0) ::close(descriptor_);
        descriptor_ = -1;
        return std::unexpected(
            Sentence{"no socket can listen at \"", path, "\" (", std::strerror(error), "); ", cure});
    };
    if (const std::size_t slash = path.rfind('/'); slash != std::string_view::npos && slash > 0) {
        path_[slash] = '\0';
        const bool there = mkdir(path_, 0755) == 0 || errno == EEXIST;
        path_[slash] = '/';
        if (!there) return refused("name a directory whose parent exists and may be written");
    }
    descriptor_ = new_socket();
    if (descriptor_ < 0) return refused("allow this process more open files");
    const sockaddr_un address = address_of(path_);
    if (connect_to(descriptor_, address)) {
        errno = EADDRINUSE;
        return refused("another machine of this name runs: stop it, or give this one another directory");
    }
    // Nobody listens there any more: a killed machine left it behind.
    struct stat left{};
    if (errno == ECONNREFUSED && lstat(path_, &left) == 0 && S_ISSOCK(left.st_mode)) unlink(path_);
    ::close(descriptor_);
    descriptor_ = new_socket();
    // Closed to everybody until its permissions are set.
    const mode_t before = umask(0777);
    const bool bound = descriptor_ >= 0 &&
                       bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    umask(before);
    if (!bound) return refused("name a directory that may be written, with nothing else of that name in it");
    if ((group >= 0 && chown(path_, static_cast<uid_t>(-1), static_cast<gid_t>(group)) != 0) ||
        chmod(path_, mode) != 0 || ::listen(descriptor_, 8) != 0)
        return refused("run as root, or as a member of the group that the board names");
    return {};
}

LocalConnection LocalListener::accept() const noexcept {
    return LocalConnection{accept4(descriptor_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)};
}

void LocalListener::close() noexcept {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    unlink(path_);
    descriptor_ = -1;
}

} // namespace tappet::os

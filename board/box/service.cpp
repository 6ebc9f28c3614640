// SPDX-License-Identifier: Apache-2.0
// The service's socket, its folder and its rights.
#include "board/box/service.hpp"

#include "board/box/reception.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <grp.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::box {

namespace {

constexpr uid_t nobody = 65534;
constexpr int most_waiting = 16; // connections not yet greeted

[[noreturn]] void fail(const char* what) {
    std::fprintf(stderr, "service: %s: %s; the box takes updates from a stick only\n", what,
                 std::strerror(errno));
    ::_exit(1);
}

int listen_at(std::uint16_t port) {
    const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const int yes = 1;
    ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    if (::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listener, most_waiting) != 0)
        fail("cannot listen");
    return listener;
}

void give_up_rights() {
    const rlimit none{0, 0}; // no more processes
    if (::chdir(service_folder) != 0 || ::chroot(".") != 0 || ::setgroups(0, nullptr) != 0 ||
        ::setresgid(nobody, nobody, nobody) != 0 || ::setresuid(nobody, nobody, nobody) != 0 ||
        ::setrlimit(RLIMIT_NPROC, &none) != 0 || ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
        fail("cannot drop its privileges");
}

} // namespace

init::Done make_service_folder() {
    const std::string offers = std::string{service_folder} + "/" + offers_folder;
    init::make_folder(service_folder);
    if (::mount("tmpfs", service_folder, "tmpfs", MS_NOSUID | MS_NODEV | MS_NOEXEC, "size=50%,mode=0755") !=
        0)
        return init::failed(std::string{"mount "} + service_folder);
    init::make_folder(offers);
    if (::chown(offers.c_str(), nobody, nobody) != 0)
        return init::failed("make user nobody the owner of " + offers);
    return {};
}

std::string new_nonce() {
    std::array<unsigned char, 16> bytes{};
    std::string digits;
    ssize_t got = -1;
    do got = ::getrandom(bytes.data(), bytes.size(), 0);
    while (got < 0 && errno == EINTR); // the end of a child can interrupt the wait for entropy
    if (got != static_cast<ssize_t>(bytes.size())) return digits;
    for (const unsigned char byte : bytes)
        digits += {"0123456789abcdef"[byte >> 4], "0123456789abcdef"[byte & 15]};
    return digits;
}

void serve_network(const ServiceFacts& facts) {
    // When somebody fills the memory, this process is killed, and no other.
    static_cast<void>(init::write_text("/proc/self/oom_score_adj", "1000"));
    sched_param idle{};
    ::sched_setscheduler(0, SCHED_IDLE, &idle);
    const int listener = listen_at(facts.port);
    give_up_rights();
    std::printf("service: it listens at port %u\n", facts.port);
    std::fflush(stdout);
    Reception reception{facts};
    for (;;) {
        // One new client per turn, so that the others are read before the next one takes a place.
        if (reception.wait(listener)) {
            sockaddr_in from{};
            socklen_t size = sizeof from;
            const int socket = ::accept4(listener, reinterpret_cast<sockaddr*>(&from), &size, SOCK_CLOEXEC);
            if (socket >= 0) reception.greet(socket, from.sin_addr.s_addr, Reception::Clock::now());
        }
        reception.hear(Reception::Clock::now());
    }
}

} // namespace tappet::box

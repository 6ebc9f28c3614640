// SPDX-License-Identifier: Apache-2.0
// One client after the other, each with little time.
#include "board/box/service.hpp"

#include "board/box/facts.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <grp.h>
#include <netinet/in.h>
#include <poll.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tappet::box {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t longest_line = 512;
constexpr std::chrono::seconds for_a_line{10};
constexpr std::chrono::seconds for_an_update{300};
constexpr uid_t nobody = 65534;

class Client {
public:
    explicit Client(int socket) : socket_{socket} {}
    ~Client() { ::close(socket_); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    /// Without its end; none when none came in time, or a longer one.
    std::optional<std::string> read_line() {
        const auto until = Clock::now() + for_a_line;
        std::string line;
        char character = 0;
        while (line.size() < longest_line && await(until) && ::recv(socket_, &character, 1, 0) == 1) {
            if (character == '\n') return line;
            line += character;
        }
        return std::nullopt;
    }
    /// As many bytes as asked for, or what came before the client went or its time was over.
    std::string read(std::uint64_t count, Clock::time_point until) {
        std::string bytes;
        std::array<char, 65536> piece{};
        while (bytes.size() < count && await(until)) {
            const auto wanted =
                static_cast<std::size_t>(std::min<std::uint64_t>(piece.size(), count - bytes.size()));
            const ssize_t n = ::recv(socket_, piece.data(), wanted, 0);
            if (n <= 0) break;
            bytes.append(piece.data(), static_cast<std::size_t>(n));
        }
        return bytes;
    }
    /// Who does not listen is not waited for: a client reads what fits its window, and that is more than is
    /// said.
    void say(std::string_view text) const {
        [[maybe_unused]] const ssize_t n =
            ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    }
    /// What stays unread at a hang-up would take the answer with it.
    void drain() {
        ::shutdown(socket_, SHUT_WR);
        const auto until = Clock::now() + std::chrono::seconds{2};
        std::array<char, 65536> piece{};
        while (await(until) && ::recv(socket_, piece.data(), piece.size(), 0) > 0) {
        }
    }

private:
    bool await(Clock::time_point until) const {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
        pollfd file{socket_, POLLIN, 0};
        return left > 0 && ::poll(&file, 1, static_cast<int>(left)) == 1;
    }
    int socket_;
};

/// The version of the update that waits for the power button. 0: none waits.
std::uint32_t waiting_version() {
    std::string header(update_header_bytes, '\0');
    std::FILE* const file = std::fopen(offered_update, "rb");
    if (file == nullptr) return 0;
    header.resize(std::fread(header.data(), 1, header.size(), file));
    std::fclose(file);
    return claimed_bytes(header) == 0 ? 0 : manifest_of(header).version;
}

/// What is offered appears whole, or not at all; the next one replaces it.
bool keep(const char* name, std::string_view bytes) {
    const std::string part = std::string{name} + ".part";
    std::FILE* const file = std::fopen(part.c_str(), "wb");
    if (file == nullptr) return false;
    bool well = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    well = std::fclose(file) == 0 && well;
    if (well) return std::rename(part.c_str(), name) == 0;
    ::unlink(part.c_str());
    return false;
}

constexpr const char* accepted = "; press the power button at the machine: it stops, and then it is done\n";

std::string take_update(Client& client, const ServiceFacts& facts) {
    const auto until = Clock::now() + for_an_update;
    std::string bytes = client.read(update_header_bytes, until);
    const std::uint64_t claimed = claimed_bytes(bytes);
    if (claimed == 0) return "refused\nit is no update; send the update.tap beside an image\n";
    if (claimed > most_update_bytes) return "refused\nit says that it has more bytes than a slot\n";
    // Before all of it is sent.
    const Manifest offered = manifest_of(bytes);
    if (const std::string why = refusal_of(offered, facts.own); !why.empty()) return "refused\n" + why + "\n";
    // Older ones are signed, too: somebody could keep a newer one from ever being taken.
    if (const auto waiting = waiting_version(); offered.version < waiting)
        return "refused\nit is version " + std::to_string(offered.version) + ", and version " +
               std::to_string(waiting) + " waits for the power button\n";
    bytes += client.read(claimed - bytes.size(), until);
    const auto update = decode(bytes, *facts.key);
    if (!update) return "refused\n" + update.error() + "\n";
    if (!keep(offered_update, bytes)) return "refused\nthe box has no memory left for it\n";
    std::string text =
        "ok\nversion " + std::to_string(update->manifest.version) + " is here and its signature fits";
    if (update->manifest.layout != facts.own.layout)
        text += "; its properties are others: what it does not know is kept for the version that does";
    return text + accepted;
}

std::string take_order(const Words& words, const ServiceFacts& facts) {
    if (words.size() != 3 || std::ranges::find(order_verbs, words[1]) == order_verbs.end())
        return "refused\nthere are the orders roll-back, factory-reset and measure\n";
    if (!is_signed({words[1], facts.own.machine, facts.own.board, facts.nonce}, words[2], *facts.key))
        return "refused\nits signature does not fit this box's key, or it is of another day\n";
    if (!keep(offered_order, words[1] + "\n" + words[2] + "\n"))
        return "refused\nthe box has no memory left\n";
    return "ok\n" + words[1] + accepted;
}

std::string what_waits() {
    std::string text;
    for (const auto& [file, what] : {std::pair{offered_update, "update"}, {offered_order, "order"}})
        if (::access(file, F_OK) == 0) text += std::string{"an "} + what + " waits for the power button\n";
    return text;
}

void serve(Client& client, const ServiceFacts& facts) {
    client.say(std::string{service_greeting} + facts.own.machine + " " + facts.own.board + " " + facts.nonce +
               "\n");
    const auto line = client.read_line();
    if (!line) return;
    const Facts lines{*line};
    const Words words = lines.lines().empty() ? Words{""} : lines.lines().front();
    if (words[0] == "status")
        client.say("ok\n" + init::read_text(status_file) + what_waits());
    else if (!facts.key)
        client.say("refused\nthis box's image has no key; flash one that was written with --key\n");
    else if (words[0] == "update")
        client.say(take_update(client, facts));
    else if (words[0] == "order")
        client.say(take_order(words, facts));
    else
        client.say("refused\nthere are status, update and order\n");
    client.drain();
}

[[noreturn]] void fail(const char* what) {
    std::fprintf(stderr, "service: %s: %s; the box takes updates from a stick only\n", what,
                 std::strerror(errno));
    ::_exit(1);
}

int listen_at(std::uint16_t port) {
    const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int yes = 1;
    ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    if (::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listener, 4) != 0)
        fail("cannot listen");
    return listener;
}

void give_up_rights() {
    const rlimit none{0, 0}; // of further processes
    if (::chdir(service_folder) != 0 || ::chroot(".") != 0 || ::setgroups(0, nullptr) != 0 ||
        ::setresgid(nobody, nobody, nobody) != 0 || ::setresuid(nobody, nobody, nobody) != 0 ||
        ::setrlimit(RLIMIT_NPROC, &none) != 0 || ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
        fail("cannot give up its rights");
}

} // namespace

init::Done make_service_folder() {
    const std::string offers = std::string{service_folder} + "/" + offers_folder;
    init::make_folder(service_folder);
    if (::mount("tmpfs", service_folder, "tmpfs", MS_NOSUID | MS_NODEV | MS_NOEXEC, "size=50%,mode=0755") !=
        0)
        return init::failed(std::string{"mount "} + service_folder);
    init::make_folder(offers);
    if (::chown(offers.c_str(), nobody, nobody) != 0) return init::failed("give nobody " + offers);
    return {};
}

std::string new_nonce() {
    std::array<unsigned char, 16> bytes{};
    std::string digits;
    ssize_t got = -1;
    do got = ::getrandom(bytes.data(), bytes.size(), 0);
    while (got < 0 && errno == EINTR); // a child's end, while chance is gathered
    if (got != static_cast<ssize_t>(bytes.size())) return digits;
    for (const unsigned char byte : bytes)
        digits += {"0123456789abcdef"[byte >> 4], "0123456789abcdef"[byte & 15]};
    return digits;
}

void serve_network(const ServiceFacts& facts) {
    // Whoever sends what fills the memory ends this process, and no other.
    static_cast<void>(init::write_text("/proc/self/oom_score_adj", "1000"));
    sched_param idle{};
    ::sched_setscheduler(0, SCHED_IDLE, &idle);
    const int listener = listen_at(facts.port);
    give_up_rights();
    std::printf("service: it listens at port %u\n", facts.port);
    std::fflush(stdout);
    for (;;) {
        const int socket = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
        if (socket < 0) continue;
        Client client{socket};
        serve(client, facts);
    }
}

} // namespace tappet::box

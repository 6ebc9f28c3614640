// SPDX-License-Identifier: Apache-2.0
// Opens one connection per request.
#include "toolchain/tools/image/remote.hpp"

#include "board/box/facts.hpp"
#include "board/box/service.hpp"
#include "toolchain/tools/image/tool.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace tappet::image {

namespace {

constexpr timeval patience{30, 0};            // for the other end; the box needs seconds to check an update
constexpr std::size_t most_told = 256 * 1024; // limit, since the other end may be no box

/// Returns text from the network without control characters, which could affect the terminal.
std::string only_text(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return (c < ' ' && c != '\n' && c != '\t') || c > '~'; }, '?');
    return text;
}

/// Closes the socket even when an exception follows its opening.
struct Socket {
    int number = -1;
    Socket() = default;
    ~Socket() {
        if (number >= 0) ::close(number);
    }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
};

class Connection {
public:
    explicit Connection(const std::string& box) : box_{box} {
        const std::size_t colon = box.find(':');
        const std::string host = box.substr(0, colon);
        const std::string port =
            colon == std::string::npos ? std::to_string(box::service_port) : box.substr(colon + 1);
        addrinfo wanted{};
        wanted.ai_socktype = SOCK_STREAM;
        addrinfo* found = nullptr;
        if (const int code = ::getaddrinfo(host.c_str(), port.c_str(), &wanted, &found); code != 0)
            throw Fault("\"" + box + "\" is not the address of a box: " + ::gai_strerror(code));
        const std::unique_ptr<addrinfo, void (*)(addrinfo*)> addresses{found, ::freeaddrinfo};
        for (const addrinfo* each = found; each != nullptr && socket_.number < 0; each = each->ai_next) {
            socket_.number = ::socket(each->ai_family, each->ai_socktype | SOCK_CLOEXEC, each->ai_protocol);
            ::setsockopt(socket_.number, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
            ::setsockopt(socket_.number, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
            if (::connect(socket_.number, each->ai_addr, each->ai_addrlen) == 0) continue;
            ::close(socket_.number);
            socket_.number = -1;
        }
        if (socket_.number < 0)
            throw Fault("no box answers at " + box + ": " + std::strerror(errno) +
                        "; check the address, and that its board has a service_port");
        const std::string hello = read_until('\n');
        if (!hello.starts_with(box::service_greeting))
            throw Fault("the program that answers at " + box + " is not a box");
        const box::Facts facts{hello.substr(box::service_greeting.size())};
        if (facts.lines().empty() || facts.lines().front().size() != 3)
            throw Fault("the box at " + box + " speaks another version of the protocol");
        const box::Words& words = facts.lines().front();
        order_ = {{}, words[0], words[1], words[2]};
    }
    /// Sends the bytes. Returns false when the other end has hung up; it may have sent the reason.
    bool send(std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t n = ::send(socket_.number, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (n <= 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(n));
        }
        return true;
    }
    Answer answer() {
        ::shutdown(socket_.number, SHUT_WR);
        const std::string all = read_until(std::nullopt);
        const std::size_t line = all.find('\n');
        if (line == std::string::npos)
            throw Fault("the box at " + box_ +
                        " closed the connection without an answer; ask for its status by tappet box " + box_);
        return {all.substr(0, line) == "ok", only_text(all.substr(line + 1))};
    }
    /// Returns the order; the caller adds a verb.
    [[nodiscard]] box::Order order() const { return order_; }

private:
    std::string read_until(std::optional<char> end) const {
        std::string text;
        std::array<char, 4096> piece{};
        for (ssize_t n = 1; n > 0 && text.size() < most_told && !(end && text.ends_with(*end));) {
            n = ::recv(socket_.number, piece.data(), end ? 1 : piece.size(), 0);
            if (n > 0) text.append(piece.data(), static_cast<std::size_t>(n));
        }
        return text;
    }

    std::string box_;
    Socket socket_{};
    box::Order order_{};
};

} // namespace

Answer ask_status(const std::string& box) {
    Connection connection{box};
    connection.send("status\n");
    return connection.answer();
}

Answer send_update(const std::string& box, const std::filesystem::path& file,
                   const std::function<void(std::uint64_t, std::uint64_t)>& done) {
    const std::string bytes = read_file(file);
    if (box::claimed_bytes(bytes) != bytes.size())
        throw Fault(
            file.string() +
            " is not a complete update; name the update.tap that was written with an image and --key");
    Connection connection{box};
    connection.send("update\n");
    constexpr std::size_t piece = 256 * 1024;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
        if (!connection.send(std::string_view{bytes}.substr(at, piece))) break;
        if (done) done(std::min(at + piece, bytes.size()), bytes.size());
    }
    return connection.answer();
}

Answer send_order(const std::string& box, const std::string& verb, const box::SecretKey& key) {
    Connection connection{box};
    box::Order order = connection.order();
    order.verb = verb;
    connection.send("order " + verb + " " + box::sign(order, key) + "\n");
    return connection.answer();
}

} // namespace tappet::image

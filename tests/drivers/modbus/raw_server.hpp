// A Modbus server made of bytes, for tests: it knows the frames but not our code, and can answer wrongly on
// purpose.
#pragma once

#include "tests/drivers/loopback.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <functional>
#include <mutex>
#include <poll.h>
#include <string>
#include <termios.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace tappet::modbus {

enum class Manner {
    right,
    silent,
    wrong_transaction,
    short_answer,
    exception,
    late, ///< the answer waits until the test calls let_go()
    close,
    wrong_checksum,
    stray,     ///< a byte of noise before the answer
    elsewhere, ///< it confirms a write to the place behind
    drip,      ///< half of the answer, and no more
    dribble    ///< all of it, a byte every 50 ms
};

using Bytes = std::vector<std::uint8_t>;

/// The answer of a server whose register n holds n + 1000 and whose coil n is set when n is odd.
inline Bytes answer_to(const Bytes& pdu, Manner manner) {
    const auto word = [&](std::size_t i) { return static_cast<unsigned>(pdu[i] << 8 | pdu[i + 1]); };
    const std::uint8_t function = pdu[0];
    if (manner == Manner::exception) return {static_cast<std::uint8_t>(function | 0x80), 6};
    const unsigned address = word(1);
    const unsigned count = word(3);
    if (function == 3 || function == 4) {
        Bytes answer{function, static_cast<std::uint8_t>(2 * count)};
        for (unsigned i = 0; i < count; ++i) {
            answer.push_back(static_cast<std::uint8_t>((address + i + 1000) >> 8));
            answer.push_back(static_cast<std::uint8_t>((address + i + 1000) & 0xFF));
        }
        if (manner == Manner::short_answer) {
            answer.resize(answer.size() - 2);
            answer[1] = static_cast<std::uint8_t>(answer[1] - 2);
        }
        return answer;
    }
    if (function == 1 || function == 2) {
        Bytes answer{function, static_cast<std::uint8_t>((count + 7) / 8)};
        answer.resize(2 + (count + 7) / 8);
        for (unsigned i = 0; i < count; ++i)
            if ((address + i) % 2 == 1)
                answer[2 + i / 8] = static_cast<std::uint8_t>(answer[2 + i / 8] | 1u << i % 8);
        return answer;
    }
    const auto place = static_cast<std::uint8_t>(pdu[2] + (manner == Manner::elsewhere ? 1 : 0));
    return {function, pdu[1], place, pdu[3], pdu[4]}; // a multiple write is answered with its range
}

inline std::uint16_t checksum(const Bytes& bytes, std::size_t n) {
    unsigned crc = 0xFFFF;
    for (std::size_t i = 0; i < n; ++i) {
        crc ^= bytes[i];
        for (int b = 0; b < 8; ++b) crc = (crc & 1u) != 0 ? crc >> 1 ^ 0xA001u : crc >> 1;
    }
    return static_cast<std::uint16_t>(crc);
}

class RawServer {
public:
    enum class Line { tcp, serial };
    explicit RawServer(Line line) : line_{line} {
        if (line == Line::tcp)
            listen_on_loopback();
        else
            open_terminal();
        thread_ = std::thread{[this] { serve(); }};
    }
    ~RawServer() {
        stop_ = true;
        thread_.join();
        for (const int fd : {peer_, listener_, keep_open_})
            if (fd >= 0) ::close(fd);
    }
    RawServer(const RawServer&) = delete;
    RawServer& operator=(const RawServer&) = delete;
    [[nodiscard]] std::uint16_t port() const { return port_; }
    [[nodiscard]] const std::string& terminal() const { return terminal_; }
    [[nodiscard]] Bytes last_request() const {
        const std::lock_guard lock{mutex_};
        return last_;
    }
    [[nodiscard]] int requests() const {
        const std::lock_guard lock{mutex_};
        return requests_;
    }
    /// Called before the answer, with the number of the request and the request.
    void on_request(std::function<void(int, const Bytes&)> act) {
        const std::lock_guard lock{mutex_};
        on_request_ = std::move(act);
    }
    /// Sends a late answer; it is out when this returns.
    void let_go() {
        const unsigned before = answered_;
        let_go_ = true;
        while (answered_ == before) std::this_thread::sleep_for(std::chrono::milliseconds{1});
        let_go_ = false;
    }
    std::atomic<Manner> manner{Manner::right};

private:
    void listen_on_loopback() {
        const auto [socket, port] = bound_to_loopback(SOCK_STREAM);
        if (::listen(socket, 4) != 0) std::abort();
        listener_ = socket, port_ = port;
    }
    void open_terminal() {
        peer_ = ::posix_openpt(O_RDWR | O_NOCTTY);
        if (peer_ < 0 || ::grantpt(peer_) != 0 || ::unlockpt(peer_) != 0) std::abort();
        terminal_ = ::ptsname(peer_);
        keep_open_ = ::open(terminal_.c_str(), O_RDWR | O_NOCTTY); // a terminal without a user would hang up
        termios raw{};
        ::cfmakeraw(&raw);
        ::tcsetattr(keep_open_, TCSANOW, &raw);
    }
    static bool readable(int fd) {
        pollfd p{fd, POLLIN, 0};
        return ::poll(&p, 1, 5) > 0;
    }
    void serve() {
        while (!stop_) {
            if (line_ == Line::tcp && listener_ >= 0 && readable(listener_)) {
                if (peer_ >= 0) ::close(peer_);
                peer_ = ::accept(listener_, nullptr, nullptr);
            }
            if (peer_ < 0 || !readable(peer_)) continue;
            Bytes bytes(512);
            const ssize_t n = ::read(peer_, bytes.data(), bytes.size());
            if (n <= 0) {
                if (line_ == Line::tcp) ::close(peer_), peer_ = -1;
                continue;
            }
            bytes.resize(static_cast<std::size_t>(n));
            {
                const std::lock_guard lock{mutex_};
                last_ = bytes;
                ++requests_;
                if (on_request_) on_request_(requests_, bytes);
            }
            reply(bytes);
        }
    }
    void reply(const Bytes& request) {
        const Manner how = manner;
        if (how == Manner::silent) return;
        if (how == Manner::close && line_ == Line::tcp) {
            ::close(peer_);
            peer_ = -1;
            return;
        }
        const bool tcp = line_ == Line::tcp;
        const Bytes pdu(request.begin() + (tcp ? 7 : 1), request.end() - (tcp ? 0 : 2));
        const Bytes body = answer_to(pdu, how);
        Bytes answer;
        if (tcp) {
            answer = {request[0], request[1], 0, 0, 0, static_cast<std::uint8_t>(body.size() + 1),
                      request[6]};
            if (how == Manner::wrong_transaction) answer[1] = static_cast<std::uint8_t>(answer[1] + 1);
        } else {
            answer = {request[0]};
        }
        answer.insert(answer.end(), body.begin(), body.end());
        if (!tcp) {
            const std::uint16_t crc = checksum(answer, answer.size());
            answer.push_back(static_cast<std::uint8_t>(crc & 0xFF));
            answer.push_back(
                static_cast<std::uint8_t>(how == Manner::wrong_checksum ? ~crc >> 8 & 0xFF : crc >> 8));
        }
        while (how == Manner::late && !let_go_ && !stop_)
            std::this_thread::sleep_for(std::chrono::milliseconds{1});
        if (how == Manner::stray) answer.insert(answer.begin(), 0x55);
        if (how == Manner::drip) answer.resize(answer.size() / 2);
        const std::size_t at_once = how == Manner::dribble ? 1 : answer.size();
        for (std::size_t i = 0; i < answer.size() && !stop_ && put(answer.data() + i, at_once); i += at_once)
            if (how == Manner::dribble) std::this_thread::sleep_for(std::chrono::milliseconds{50});
        ++answered_;
    }
    [[nodiscard]] bool put(const std::uint8_t* bytes, std::size_t count) const {
        return (line_ == Line::tcp ? ::send(peer_, bytes, count, MSG_NOSIGNAL)
                                   : ::write(peer_, bytes, count)) > 0;
    }

    Line line_;
    int listener_ = -1;
    int peer_ = -1;
    int keep_open_ = -1;
    std::uint16_t port_ = 0;
    std::string terminal_;
    mutable std::mutex mutex_;
    Bytes last_;
    int requests_ = 0;
    std::function<void(int, const Bytes&)> on_request_;
    std::atomic<bool> stop_{false}, let_go_{false};
    std::atomic<unsigned> answered_{0};
    std::thread thread_;
};

} // namespace tappet::modbus

// Its socket and its process.
#include "tests/drivers/canopen/peer.hpp"

#include "tests/drivers/can/hex.hpp"
#include "tests/drivers/foreign.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

namespace tappet::test {
namespace {

std::string command(const std::string& arguments) {
    return "env NODE_PATH=" TAPPET_NPM "/node_modules node " TAPPET_PEER " " + arguments;
}

can::Frame to_frame(const std::string& line) {
    const std::size_t second = line.find(' ', 2);
    can::Frame frame;
    frame.id = static_cast<std::uint32_t>(std::stoul(line.substr(2, second - 2), nullptr, 16));
    const std::string hex = line.substr(second + 1);
    frame.length = static_cast<std::uint8_t>(std::min<std::size_t>(hex.size() / 2, 8));
    for (std::size_t i = 0; i < frame.length; ++i)
        frame.data[i] = static_cast<std::uint8_t>(std::stoul(hex.substr(2 * i, 2), nullptr, 16));
    return frame;
}

} // namespace

Peer::Peer(const std::string& arguments) {
    const char* const folder = std::getenv("TMPDIR");
    place_ = std::string{folder != nullptr ? folder : "/tmp"} + "/peer." + std::to_string(::getpid());
    ::unlink(place_.c_str());
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    place_.copy(address.sun_path, sizeof address.sun_path - 1);
    const int door = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (::bind(door, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(door, 1) != 0)
        ADD_FAILURE() << "no socket " << place_;
    process_ = std::make_unique<Foreign>(command(arguments + " " + place_));
    pollfd wait{door, POLLIN, 0};
    while (socket_ < 0 && process_->runs())
        if (::poll(&wait, 1, 100) == 1) socket_ = ::accept4(door, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket_ < 0) ADD_FAILURE() << "it does not come: " << process_->output();
    ::close(door);
}

Peer::~Peer() {
    ::close(socket_);
    process_.reset();
    ::unlink(place_.c_str());
}

void Peer::give(const can::Frame& frame) {
    pending_ += "f ";
    for (int shift = 8; shift >= 0; shift -= 4) pending_ += "0123456789abcdef"[frame.id >> shift & 0xF];
    pending_ += ' ' + can::hex_of(frame) + '\n';
}

std::vector<can::Frame> Peer::move_to(std::int64_t ms) {
    pending_ += "t " + std::to_string(ms) + "\n";
    if (::send(socket_, pending_.data(), pending_.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(pending_.size()))
        ADD_FAILURE() << "it went away: " << process_->output();
    pending_.clear();
    std::vector<can::Frame> frames;
    for (std::string line = read_line(); !line.empty() && line != "d"; line = read_line()) {
        if (line[0] == 'r') told.push_back(line.substr(2));
        if (line[0] == 'f') frames.push_back(to_frame(line));
    }
    return frames;
}

bool Peer::has_told(const std::string& text) const { return std::ranges::find(told, text) != told.end(); }

/// Empty: the process is gone.
std::string Peer::read_line() {
    for (;;) {
        if (const std::size_t end = arrived_.find('\n'); end != std::string::npos) {
            const std::string line = arrived_.substr(0, end);
            arrived_.erase(0, end + 1);
            return line;
        }
        char bytes[4096];
        const ssize_t got = ::read(socket_, bytes, sizeof bytes);
        if (got <= 0) {
            ADD_FAILURE() << "it went away: " << process_->output();
            return {};
        }
        arrived_.append(bytes, static_cast<std::size_t>(got));
    }
}

std::string output_of_peer(const std::string& arguments) {
    Foreign program{command(arguments)};
    EXPECT_EQ(program.wait(), 0) << program.output();
    return program.output();
}

} // namespace tappet::test

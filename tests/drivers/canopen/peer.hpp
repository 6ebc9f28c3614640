// A CANopen device in a process that is not ours, in step with the test's own time; see peer.js.
#pragma once

#include "drivers/can/frame.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tappet {
class Foreign;
}

namespace tappet::test {

class Peer {
public:
    /// `arguments` without the socket, which comes last.
    explicit Peer(const std::string& arguments);
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;
    ~Peer();

    /// Delivers the frame before the next move.
    void give(const can::Frame& frame);
    /// Advances its time, and collects the frames and reports until then.
    std::vector<can::Frame> move_to(std::int64_t ms);
    [[nodiscard]] bool has_told(const std::string& text) const;

    std::vector<std::string> told;

private:
    std::string read_line();

    std::string place_;
    std::unique_ptr<Foreign> process_;
    int socket_ = -1;
    std::string pending_, arrived_;
};

/// The output of a peer that runs without a socket.
std::string output_of_peer(const std::string& arguments);

} // namespace tappet::test

// A connection to a machine's socket for one client of the gateway.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace tappet::network {

/// Carries packets in both directions, each whole. It ends when it is destroyed.
class Relay {
public:
    Relay() = default;
    Relay(const Relay&) = delete;
    Relay& operator=(const Relay&) = delete;
    virtual ~Relay() = default;
    /// Returns false when the machine accepts no packet now.
    [[nodiscard]] virtual bool send(std::string_view packet) = 0;
};

/// Receives each packet; an empty one: the machine closed the connection.
using OnPacket = std::function<void(std::string_view packet)>;
/// Connects to a socket; null: it failed, and `fault` says why.
using Connect =
    std::function<std::unique_ptr<Relay>(const std::string& socket, OnPacket receive, std::string& fault)>;

} // namespace tappet::network

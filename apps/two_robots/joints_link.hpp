// Keeps the plants of both robots one cell when each runs in its own process: one plant sends the true
// positions of its joints to the other.
#pragma once

#include "apps/two_robots/values.hpp"
#include "drivers/udp/sender.hpp"
#include "drivers/udp/socket.hpp"
#include "kernel/base/text.hpp"

#include <charconv>
#include <optional>

namespace two_robots {

/// Connects two plants on one box. Not real-time.
class JointsLink {
public:
    static constexpr std::string_view box = "127.0.0.1";

    /// Opens the port; returns empty when the port is valid.
    Sentence tell(std::string_view port) {
        return with(port, [this](std::uint16_t number) { return teller_.emplace().open(box, number); });
    }
    Sentence listen(std::string_view port) {
        return with(port, [this](std::uint16_t number) { return listener_.emplace().open(box, number); });
    }
    [[nodiscard]] bool listens() const { return listener_.has_value(); }

    /// Sends the joints. A lost message does not matter: the next one follows.
    void put(const Joints& joints) {
        if (!teller_) return;
        const SixNumbers numbers{joints};
        static_cast<void>(teller_->tell(std::as_bytes(std::span{numbers.of})));
    }
    void take(Joints& joints) {
        SixNumbers numbers;
        while (listener_ &&
               listener_->receive(std::as_writable_bytes(std::span{numbers.of})) == sizeof numbers.of)
            joints = numbers.joints();
    }

private:
    template <class Open>
    static Sentence with(std::string_view port, Open open) {
        std::uint16_t number = 0;
        const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
        if (error != std::errc{} || end != port.data() + port.size() || number == 0)
            return Sentence{"\"", port, "\" is not a port; write one from 1 to 65535"};
        const auto opened = open(number);
        return opened ? Sentence{} : opened.error();
    }

    std::optional<udp::Sender> teller_;
    std::optional<udp::Socket> listener_;
};

} // namespace two_robots

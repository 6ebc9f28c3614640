// A browser of a machine under virtual time: it asks over the machine's own socket, and is answered when the
// machine's service comes to it.
#pragma once

#include "kernel/base/time.hpp"
#include "kernel/os/local_socket.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace tappet {

/// Not real-time.
class SwarmBrowser {
public:
    /// Called once with the answer; an empty one: the connection ended before it came.
    using Then = std::function<void(std::string_view answer)>;
    struct Asked {
        Time at{};
        std::string request;
        Then then;
    };

    /// `socket`: the machine's, be it there yet or not. `user`: who asks, where this process may become him;
    /// otherwise it is the machine's own user.
    explicit SwarmBrowser(std::string socket, std::uint32_t user = os::own_user())
        : socket_{std::move(socket)}, user_{user} {}

    void ask(std::string request, Time now, Then then);
    /// Connects when it is not connected, and takes what has come. False: there is no connection.
    bool hear();
    void leave();
    /// Each packet that answers no request: of a command that is followed, of an event.
    void tell_by(std::function<void(std::string_view packet)> tell) { tell_ = std::move(tell); }
    /// Whose answer has been outstanding longest; null: nobody's.
    [[nodiscard]] const Asked* oldest() const { return asked_.empty() ? nullptr : &asked_.begin()->second; }
    /// How many answers are outstanding.
    [[nodiscard]] std::size_t waits_for() const { return asked_.size(); }
    /// Rises with each connection.
    [[nodiscard]] std::uint64_t connections() const { return connections_; }

private:
    void take(std::string_view packet);

    std::string socket_;
    std::uint32_t user_;
    os::LocalConnection connection_{};
    std::uint64_t connections_ = 0;
    std::uint32_t number_ = 0;
    std::map<std::uint32_t, Asked> asked_{};
    std::function<void(std::string_view)> tell_{};
};

/// Of an answer: whether it says "ok".
[[nodiscard]] bool is_good(std::string_view answer);
/// Of a packet: the text or the number of a field; empty: it has none.
[[nodiscard]] std::string field_of(std::string_view packet, std::string_view name);

} // namespace tappet

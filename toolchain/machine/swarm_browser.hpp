// A browser of a machine under virtual time: sends requests over the machine's own socket, and gets the
// answers when the machine's service runs.
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
    /// Called once with the answer; with an empty one when the connection ended before it came.
    using Then = std::function<void(std::string_view answer)>;
    struct Asked {
        Time at{};
        std::string request;
        Then then;
    };

    /// `socket`: the machine's, which may not exist yet. `user`: the sender, if this process may take that
    /// user's identity; otherwise the machine's own user.
    explicit SwarmBrowser(std::string socket, std::uint32_t user = os::own_user())
        : socket_{std::move(socket)}, user_{user} {}

    void ask(std::string request, Time now, Then then);
    /// Connects if necessary and reads what has come. Returns false when there is no connection.
    bool hear();
    void leave();
    /// Sets the receiver of packets that answer no request: of a followed command, of an event.
    void tell_by(std::function<void(std::string_view packet)> tell) { tell_ = std::move(tell); }
    /// Returns the request that has waited longest for its answer; null: none.
    [[nodiscard]] const Asked* oldest() const { return asked_.empty() ? nullptr : &asked_.begin()->second; }
    /// Returns how many answers are outstanding.
    [[nodiscard]] std::size_t waits_for() const { return asked_.size(); }
    /// Increases with each connection.
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

/// Returns whether an answer says "ok".
[[nodiscard]] bool is_good(std::string_view answer);
/// Returns the text or the number of a packet's field; empty when it has none.
[[nodiscard]] std::string field_of(std::string_view packet, std::string_view name);

} // namespace tappet

// A client's requests to one machine: relayed under the user's name, logged, and answered once each.
#pragma once

#include "toolchain/tools/gateway/hub.hpp"

#include <map>

namespace tappet::network {

class Carriage {
public:
    using Send = std::function<void(std::string text)>;
    Carriage(Hub& hub, std::string machine, LoggedIn who, std::string address, Send send)
        : hub_{hub},
          machine_{std::move(machine)},
          who_{std::move(who)},
          address_{std::move(address)},
          send_{std::move(send)} {}
    ~Carriage();
    Carriage(const Carriage&) = delete;
    Carriage& operator=(const Carriage&) = delete;

    /// Relays a line; its answers get the client's id. A failure is answered, too.
    void request(std::uint32_t id, const std::string& line, Clock::time_point now);
    [[nodiscard]] bool uses(std::uint32_t id) const { return pending_.contains(id); }
    [[nodiscard]] std::size_t under_way() const { return pending_.size(); }
    /// Returns whether nothing came or went for so long that the connection may close.
    [[nodiscard]] bool is_idle(Clock::time_point now) const;

private:
    struct Pending {
        std::uint64_t logged = 0; ///< number in the log; 0: not logged
        std::string line{};
        bool replied = false;
        std::string event{}; ///< of subscribe
    };
    void receive(std::string_view packet);
    void answer(std::uint32_t id, bool ok, std::string_view error, std::string_view packet);
    void finish(std::map<std::uint32_t, Pending>::iterator pending, std::string_view outcome);
    void fail(std::string_view code, const std::string& sentence);
    [[nodiscard]] bool pass_on(std::uint32_t id);

    Hub& hub_;
    std::string machine_;
    LoggedIn who_;
    std::string address_;
    Send send_;
    std::unique_ptr<Relay> relay_{};
    bool admitted_ = false; ///< the machine accepted name and role
    bool ended_ = false;    ///< the relay is closed, and is destroyed before the next request
    std::vector<std::uint32_t> waiting_{};
    std::map<std::uint32_t, Pending> pending_{};
    Clock::time_point used_{};
};

} // namespace tappet::network

// Failed logins: after some of them a user at an address, and the address itself, must wait.
#pragma once

#include "toolchain/tools/gateway/bounds.hpp"

#include <map>
#include <string>
#include <string_view>

namespace tappet::network {

/// Counts a login as failed when it begins, so that many at once count too; success takes it back.
/// After `bounds.failures` each further failure locks for twice the time of the one before.
class Lockout {
public:
    /// Returns the seconds left until this user may try again from this address; 0: now.
    [[nodiscard]] std::chrono::seconds left(std::string_view user, std::string_view address,
                                            Clock::time_point now) const;
    void begin(std::string_view user, std::string_view address, Clock::time_point now);
    /// Forgets the user's failures at this address. The address's own lose this one login only: who has one
    /// password gains no tries at others.
    void succeed(std::string_view user, std::string_view address);
    /// Takes one begun login back, which could not be checked.
    void take_back(std::string_view user, std::string_view address);
    [[nodiscard]] std::size_t size() const { return counts_.size(); }

private:
    struct Count {
        unsigned failures = 0;
        Clock::time_point last{};
        Clock::time_point locked_until{};
    };
    void forgive(const std::string& key, unsigned allowed);
    void fail(const std::string& key, Clock::time_point now);

    std::map<std::string, Count, std::less<>> counts_{};
};

/// Returns the part of an address that one person has: an IPv4 address, or the network of an IPv6 address.
[[nodiscard]] std::string lock_address(std::string_view address);

} // namespace tappet::network

// Sessions of logged-in users: a random token for the client, its digest here.
#pragma once

#include "kernel/component/role.hpp"
#include "toolchain/tools/gateway/bounds.hpp"

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace tappet::network {

struct LoggedIn {
    std::string user{};
    Role role = Role::observer;
    [[nodiscard]] bool operator==(const LoggedIn&) const = default;
};

class Sessions {
public:
    /// Returns the token: 256 random bits in base64. The user's oldest session ends when there are too many.
    [[nodiscard]] std::string begin(const LoggedIn& who, Clock::time_point now);
    /// Returns who has this token, and counts it as used if `use`; nothing: it is unknown, or its time is
    /// over.
    [[nodiscard]] std::optional<LoggedIn> find(std::string_view token, Clock::time_point now,
                                               bool use = true);
    /// Returns whether the session lasts, without counting it as used.
    [[nodiscard]] bool lasts(std::string_view token, Clock::time_point now);
    void end(std::string_view token);
    /// Ends the sessions of a user.
    void end_of(std::string_view user);
    [[nodiscard]] std::size_t size() const { return all_.size(); }

private:
    struct Session {
        LoggedIn who{};
        Clock::time_point begun{};
        Clock::time_point used{};
    };
    void expire(Clock::time_point now);
    void end_oldest(std::string_view user);

    std::map<std::string, Session, std::less<>> all_{}; ///< by the token's digest
};

} // namespace tappet::network

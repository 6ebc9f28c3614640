// Decides who may come in: users, passwords, lock-out and sessions together.
#pragma once

#include "toolchain/tools/gateway/lockout.hpp"
#include "toolchain/tools/gateway/sessions.hpp"
#include "toolchain/tools/gateway/users.hpp"

#include <functional>

#include <sys/stat.h>

namespace tappet::network {

/// A login whose password is being checked. The check may run on any thread: it uses only this.
struct Attempt {
    User user{}; ///< for an unknown name one that nobody has, so that the check takes as long
    bool known = false;
    std::string name{};
    std::string password{};
    std::string address{};

    /// Takes about 0.1 s.
    [[nodiscard]] bool matches() const;
};

class Access {
public:
    /// Without a users file, everyone is `local`: for the loopback only.
    explicit Access(LoggedIn local) : local_{std::move(local)} {}
    Access(std::string users_file, Users users);

    /// Returns who everyone is; nothing: people log in.
    [[nodiscard]] const std::optional<LoggedIn>& local() const { return local_; }

    /// Begins a login. The error says how long to wait.
    [[nodiscard]] std::expected<Attempt, std::string> begin(std::string_view user, std::string_view password,
                                                            std::string_view address, Clock::time_point now);
    struct Admitted {
        LoggedIn who{};
        std::string token{};
    };
    /// Ends it with the outcome of its check. The error does not say whether the name exists.
    [[nodiscard]] std::expected<Admitted, std::string> finish(const Attempt& attempt, bool matched,
                                                              Clock::time_point now);
    /// Takes a begun login back: it could not be checked.
    void cancel(const Attempt& attempt) { lockout_.take_back(attempt.name, attempt.address); }
    /// `use`: whether it counts as use of the session.
    [[nodiscard]] std::optional<LoggedIn> find(std::string_view token, Clock::time_point now,
                                               bool use = true) {
        return sessions_.find(token, now, use);
    }
    void end(std::string_view token) { sessions_.end(token); }
    [[nodiscard]] bool lasts(std::string_view token, Clock::time_point now) {
        return local_.has_value() || sessions_.lasts(token, now);
    }

    /// Returns who logged in by this name and password within the last 30 minutes, for clients that send both
    /// with each request; nothing: begin() a login, which also counts a wrong password, or says how long to
    /// wait.
    [[nodiscard]] std::optional<LoggedIn> remembered(std::string_view user, std::string_view password,
                                                     std::string_view address, Clock::time_point now);
    void remember(std::string_view user, std::string_view password, const std::string& token);

    /// Reads the users file again when it changed; sessions of users who were removed, or have another role
    /// or password, end. A file that cannot be read leaves the users as they are, and is read again each
    /// time; the error says why, once.
    [[nodiscard]] std::string refresh();

private:
    std::string path_{};
    Users users_{};
    struct stat read_{};  ///< of the file that was read
    std::string fault_{}; ///< of the last reading
    Lockout lockout_{};
    Sessions sessions_{};
    std::map<std::string, std::string, std::less<>> remembered_{}; ///< digest of name and password; token
    std::string pepper_{}; ///< of those digests: they mean nothing to another process
    std::optional<LoggedIn> local_{};
    User nobody_{};
};

} // namespace tappet::network

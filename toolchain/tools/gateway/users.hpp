// The users file: who may log in, with which role, and the scrypt hash of each password.
#pragma once

#include "kernel/component/role.hpp"
#include "toolchain/tools/gateway/secrets.hpp"

#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::network {

struct User {
    std::string name{};
    Role role = Role::observer;
    Cost cost{};
    std::string salt{};
    std::string hash{};
    [[nodiscard]] bool operator==(const User&) const = default;
};

/// Returns "observer", "operator" or "engineer" as a role.
[[nodiscard]] std::optional<Role> role_from(std::string_view text);
/// Returns what is wrong with a name; empty: 1 to 32 characters of a-z, 0-9, '.', '_' and '-'.
[[nodiscard]] std::string fault_in_name(std::string_view name);
[[nodiscard]] std::string fault_in_password(std::string_view password);
/// Returns a user with a new salt. Takes about 0.1 s.
[[nodiscard]] User user_with(std::string_view name, Role role, std::string_view password);

/// A line per user, `name role scrypt N r p salt hash`, salt and hash in base64; # begins a comment.
class Users {
public:
    /// The error names the line, and the cure.
    static std::expected<Users, std::string> parse(std::string_view text);
    /// Reads a file of at most 1 MiB that belongs to this process's user or root and that nobody else may
    /// read or write.
    static std::expected<Users, std::string> read(const std::string& path);
    /// Writes the whole file, with mode 0600, and replaces the old one at once. Returns the error; empty:
    /// none.
    [[nodiscard]] std::string write(const std::string& path) const;
    [[nodiscard]] std::string text() const;

    [[nodiscard]] const std::vector<User>& all() const { return all_; }
    [[nodiscard]] const User* find(std::string_view name) const;
    /// Adds the user, or replaces the one of the same name.
    void put(User user);
    bool remove(std::string_view name);

private:
    std::vector<User> all_{};
};

} // namespace tappet::network

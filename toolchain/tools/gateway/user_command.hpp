// tappet-gateway user: writes the users file.
#pragma once

#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

namespace tappet::network {

inline constexpr std::string_view user_usage = "  user add NAME observer|operator|engineer --users FILE\n"
                                               "  user password NAME --users FILE\n"
                                               "  user remove NAME --users FILE\n"
                                               "  user list --users FILE\n";

/// Runs `user ..`: `words` begin after it. Passwords are read from `in`, a line each. Returns the exit code:
/// 0, or 2 after a sentence on `errors`.
[[nodiscard]] int run_user_command(std::span<const std::string_view> words, const std::string& file,
                                   std::istream& in, std::ostream& out, std::ostream& errors);

} // namespace tappet::network

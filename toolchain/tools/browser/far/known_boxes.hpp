// The boxes that this user has reached, each with the fingerprint of its certificate: a changed one is
// refused.
#pragma once

#include "toolchain/tools/browser/link.hpp"

namespace tappet::browser {

/// The address of a gateway, "mill-7:8443" or "[fe80::1]:8443".
struct Address {
    std::string host{};
    std::string port{};
    std::string text{}; ///< as written, in lower-case letters: a host has one name
    /// Returns whether it names this host by its loopback interface.
    [[nodiscard]] bool is_loopback() const;
};
/// Returns the address; nothing when the word is none.
[[nodiscard]] std::optional<Address> parse_address(std::string_view word);

/// A file with a line "ADDRESS sha256:HEX" for each box.
class KnownBoxes {
public:
    explicit KnownBoxes(std::string file) : file_{std::move(file)} {}
    /// "~/.config/tappet/known_boxes", or below XDG_CONFIG_HOME; empty: this user has no home.
    [[nodiscard]] static std::string usual_file();
    /// Returns whether the box was reached by TLS before.
    [[nodiscard]] bool knows(const Address& address) const;
    /// Compares the fingerprint with the one at the first use; adds a new box. Returns what to tell the user,
    /// empty for a known box. The failure: another certificate, or a file that cannot be read or written.
    Result<std::string> check(const Address& address, const std::string& fingerprint);

private:
    std::string file_;
};

} // namespace tappet::browser

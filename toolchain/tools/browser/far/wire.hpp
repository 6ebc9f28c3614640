// The WebSocket to a gateway: texts, one frame each.
#pragma once

#include "toolchain/tools/browser/far/known_boxes.hpp"

#include <iosfwd>

namespace tappet::browser {

/// How a gateway's certificate is checked.
struct Trust {
    std::string ca{};    ///< a file with the certificates of authorities; empty: by the known boxes
    std::string known{}; ///< the file of the known boxes
};

class FarWire {
public:
    FarWire() = default;
    FarWire(const FarWire&) = delete;
    FarWire& operator=(const FarWire&) = delete;
    virtual ~FarWire() = default;

    /// Connects by TLS 1.3 and checks the certificate. At this host's loopback interface a gateway without
    /// TLS is accepted, unless it is a known box. `notes`: tells of a new box. Not longer than 10 s for each
    /// step.
    static Result<std::unique_ptr<FarWire>> open(const Address& address, const Trust& trust,
                                                 std::ostream& notes);

    /// Returns whether nobody between can read it: a password may be sent.
    [[nodiscard]] virtual bool is_secret() const = 0;
    /// Waits until it is sent.
    virtual Result<void> send(const std::string& text) = 0;
    /// Returns the next text; nothing when none came within `patience`. The failure: the connection has
    /// ended.
    virtual Result<std::optional<std::string>> receive(std::chrono::milliseconds patience) = 0;
};

} // namespace tappet::browser

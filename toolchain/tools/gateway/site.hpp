// The HTTP requests of the gateway as functions of their fields: pages, login, metrics, schema, and who may
// open a WebSocket. It knows no socket of the network.
#pragma once

#include "toolchain/tools/gateway/hub.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace tappet::network {

/// The fields that the gateway reads; a header that is there several times is joined by ", ".
struct HttpRequest {
    std::string method{};
    std::string target{};
    std::string host{};
    std::string origin{};
    std::string cookie{};
    std::string authorization{};
    std::string protocols{}; ///< of a WebSocket
    std::string accept{};
    std::string body{};
    std::string address{}; ///< of the client
};

struct HttpReply {
    unsigned status = 200;
    std::string type = "text/plain; charset=utf-8";
    std::string body{};
    std::vector<std::pair<std::string, std::string>> headers{};
};

/// The user who comes by a WebSocket; nobody: the client logs in by message.
struct Admission {
    std::optional<LoggedIn> who{};
    std::string token{};
};

inline constexpr std::string_view subprotocol = "tappet.v1";

class Site {
public:
    /// `encrypted`: clients come by TLS.
    Site(Hub& hub, bool encrypted) : hub_{hub}, encrypted_{encrypted} {}

    using OnReply = std::function<void(HttpReply reply)>;
    /// Answers a request, at once or after a password was checked.
    void answer(const HttpRequest& request, OnReply reply);
    /// Answers the wish for a WebSocket: the refusal, or who it is.
    [[nodiscard]] std::variant<HttpReply, Admission> upgrade(const HttpRequest& request);

private:
    [[nodiscard]] std::string cookie_name() const { return encrypted_ ? "__Host-tappet" : "tappet"; }
    [[nodiscard]] std::string cookie(std::string_view token, bool over) const;
    [[nodiscard]] std::string fault_in_origin(const HttpRequest& request, bool needed) const;
    [[nodiscard]] std::optional<LoggedIn> who(const HttpRequest& request, std::string& token,
                                              bool use = true);
    void post(const HttpRequest& request, OnReply reply);
    void metrics(const HttpRequest& request, OnReply reply);

    Hub& hub_;
    bool encrypted_;
};

/// Returns the headers of every reply.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> safe_headers();

} // namespace tappet::network

// A client's message on the WebSocket: JSON text of bounded size and depth, as a plain structure.
#pragma once

#include <cstdint>
#include <expected>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::network {

enum class Do : std::uint8_t { login, logout, machines, facets, watch, unwatch, request, run, end };

struct Message {
    std::uint32_t id = 0;
    Do what = Do::machines;
    // The fields of all kinds; which of them a kind has says the table of message.cpp.
    std::string user{}, password{}, session{};
    std::string machine{}, line{};
    std::vector<std::string> names{}, words{};
    double rate_hz = 5;
    std::uint32_t of = 0; ///< the id of a watch or a run
    std::map<std::string, std::string> files{};
    bool screen = false;
    std::uint32_t width = 80, height = 24;
};

struct MessageFault {
    std::uint32_t id = 0; ///< 0: it could not be read
    std::string sentence{};
};

/// Parses a message. The fault states the field, and the cure.
[[nodiscard]] std::expected<Message, MessageFault> parse_message(std::string_view text);

/// Returns {"id": n, "ok": false, "code": "..", "error": ".."}.
[[nodiscard]] std::string refusal_text(std::uint32_t id, std::string_view code, std::string_view sentence);

} // namespace tappet::network

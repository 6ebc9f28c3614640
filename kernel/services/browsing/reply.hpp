// One packet to a client, built in place.
#pragma once

#include "kernel/base/value_text.hpp"
#include "kernel/services/browsing/protocol.hpp"
#include "kernel/services/json.hpp"

#include <array>
#include <span>

namespace tappet::browsing {

/// Begins with {"id": n and ends with }. An answer that does not fit becomes a refusal.
class Reply {
public:
    explicit Reply(std::uint32_t number) noexcept : number_{number} { begin(); }
    Reply(std::uint32_t number, bool good) noexcept : Reply{number} { json_.field("ok", good); }
    Reply(std::uint32_t number, Refusal code, const Sentence& why) noexcept : Reply{number, false} {
        json_.field("code", to_text(code)).field("error", why.view());
    }
    Reply(const Reply&) = delete;
    Reply& operator=(const Reply&) = delete;

    [[nodiscard]] JsonText& json() noexcept { return json_; }
    /// Adds a value as JSON, after a key or in an array.
    Reply& value(const TypeTag& type, const std::byte* value) noexcept {
        std::array<char, max_packet_bytes> text;
        const std::size_t length = format_json(type, value, text);
        json_.fragment(length == 0 ? std::string_view{"null"} : std::string_view{text.data(), length});
        return *this;
    }
    [[nodiscard]] std::string_view finish() noexcept {
        json_.close('}').raw("\n");
        if (json_.size() == 0) {
            begin();
            json_.field("ok", false)
                .field("code", to_text(Refusal::bad_request))
                .field("error", "the answer does not fit one packet; ask for less at once")
                .close('}')
                .raw("\n");
        }
        return json_.view();
    }

private:
    void begin() noexcept {
        json_ = JsonText{buffer_};
        json_.open('{').field("id", number_);
    }

    std::uint32_t number_;
    std::array<char, max_packet_bytes> buffer_;
    JsonText json_{buffer_};
};

} // namespace tappet::browsing

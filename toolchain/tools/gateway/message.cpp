// The table of messages with their fields, and its reader.
#include "toolchain/tools/gateway/message.hpp"

#include "kernel/base/nearest.hpp"
#include "toolchain/tools/browser/value.hpp"
#include "toolchain/tools/gateway/bounds.hpp"
#include "toolchain/tools/gateway/encoding.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace tappet::network {

namespace {

using nlohmann::json;

/// A field of a message, and where it goes.
struct Field {
    std::string_view name;
    std::variant<std::string Message::*, std::vector<std::string> Message::*, double Message::*,
                 std::uint32_t Message::*, bool Message::*, std::map<std::string, std::string> Message::*>
        goes_to;
    bool needed = true;
};

struct Kind {
    std::string_view name;
    Do what;
    std::vector<Field> fields{};
};

const std::vector<Kind>& kinds() {
    // clang-format off
    static const std::vector<Kind> all{
        {"login",    Do::login,    {{"user", &Message::user, false}, {"password", &Message::password, false}, {"session", &Message::session, false}}},
        {"logout",   Do::logout,   {}},
        {"machines", Do::machines, {}},
        {"facets",   Do::facets,   {{"machine", &Message::machine}}},
        {"watch",    Do::watch,    {{"names", &Message::names}, {"rate_hz", &Message::rate_hz, false}}},
        {"unwatch",  Do::unwatch,  {{"of", &Message::of}}},
        {"request",  Do::request,  {{"machine", &Message::machine}, {"line", &Message::line}}},
        {"run",      Do::run,      {{"words", &Message::words}, {"files", &Message::files, false}, {"screen", &Message::screen, false},
                                    {"width", &Message::width, false}, {"height", &Message::height, false}}},
        {"end",      Do::end,      {{"of", &Message::of}}}};
    // clang-format on
    return all;
}

bool is_too_deep(std::string_view text) {
    std::size_t depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char character = text[i];
        if (quoted) {
            if (character == '\\')
                ++i;
            else if (character == '"')
                quoted = false;
        } else if (character == '"') {
            quoted = true;
        } else if (character == '[' || character == '{') {
            if (++depth > bounds.message_depth) return true;
        } else if ((character == ']' || character == '}') && depth > 0) {
            --depth;
        }
    }
    return false;
}

std::string take(const json& value, std::string& into) {
    if (!value.is_string()) return "is not a text";
    into = value.get<std::string>();
    return {};
}

std::string take(const json& value, double& into) {
    const double given = value.is_number() ? value.get<double>() : 0;
    if (!(given > 0) || !std::isfinite(given)) return "is not a number above 0";
    into = given;
    return {};
}

std::string take(const json& value, std::uint32_t& into) {
    const bool fits = value.is_number_unsigned() && value.get<std::uint64_t>() > 0 &&
                      value.get<std::uint64_t>() <= std::numeric_limits<std::int32_t>::max();
    if (!fits) return "is not a whole number from 1 to 2147483647";
    into = value.get<std::uint32_t>();
    return {};
}

std::string take(const json& value, std::vector<std::string>& into) {
    if (!value.is_array() || value.size() > bounds.names)
        return "is not a list of at most " + std::to_string(bounds.names) + " texts";
    for (const json& each : value) {
        if (!each.is_string()) return "is not a list of texts";
        into.push_back(each.get<std::string>());
    }
    return {};
}

std::string take(const json& value, bool& into) {
    if (!value.is_boolean()) return "is neither true nor false";
    into = value.get<bool>();
    return {};
}

std::string take(const json& value, std::map<std::string, std::string>& into) {
    if (!value.is_object() || value.size() > 16) return "is not an object of at most 16 texts";
    for (const auto& [name, each] : value.items()) {
        if (!each.is_string()) return "is not an object of texts";
        into[name] = each.get<std::string>();
    }
    return {};
}

/// Reads the fields of a kind; returns what is wrong.
std::string read_fields(const json& object, const Kind& kind, Message& message) {
    const std::string head = "\"" + std::string{kind.name} + "\": ";
    for (const auto& [name, value] : object.items()) {
        if (name == "id" || name == "do") continue;
        const auto field = std::ranges::find(kind.fields, name, &Field::name);
        if (field == kind.fields.end()) {
            Nearest nearest{std::string_view{name}};
            for (const Field& each : kind.fields) nearest.consider(each.name);
            return head + "it has no field \"" + as_utf8(cut(name, 64)) + "\"; " +
                   (nearest.best().empty() ? "see /v1/schema.json"
                                           : "did you mean \"" + std::string{nearest.best()} + "\"?");
        }
        const std::string fault =
            std::visit([&](auto place) { return take(value, message.*place); }, field->goes_to);
        if (!fault.empty()) return head + "\"" + name + "\" " + fault + "; see /v1/schema.json";
    }
    for (const Field& each : kind.fields)
        if (each.needed && !object.contains(each.name))
            return head + "the field \"" + std::string{each.name} + "\" is missing; see /v1/schema.json";
    return {};
}

} // namespace

std::expected<Message, MessageFault> parse_message(std::string_view text) {
    const auto fault = [](std::uint32_t id, std::string sentence) {
        return std::unexpected(MessageFault{id, std::move(sentence)});
    };
    if (text.size() > bounds.message_bytes || is_too_deep(text))
        return fault(0, "a message has at most " + std::to_string(bounds.message_bytes) + " bytes and " +
                            std::to_string(bounds.message_depth) + " levels of brackets; send less");
    const json object = json::parse(text, nullptr, false);
    if (!object.is_object())
        return fault(0, "a message is a JSON object; send {\"id\": 1, \"do\": \"machines\"}");
    Message message;
    if (const auto id = object.find("id"); id == object.end() || !take(*id, message.id).empty())
        return fault(0, "\"id\" is not a whole number from 1 to 2147483647; number your messages");
    const auto what = object.find("do");
    if (what == object.end() || !what->is_string())
        return fault(message.id, "\"do\" is missing; send {\"id\": 1, \"do\": \"machines\"}");
    const auto named = what->get<std::string>();
    const auto kind = std::ranges::find(kinds(), named, &Kind::name);
    if (kind == kinds().end()) {
        Nearest nearest{std::string_view{named}};
        for (const Kind& each : kinds()) nearest.consider(each.name);
        return fault(message.id,
                     "there is no \"" + as_utf8(cut(named, 64)) + "\"; " +
                         (nearest.best().empty() ? "see /v1/schema.json"
                                                 : "did you mean \"" + std::string{nearest.best()} + "\"?"));
    }
    message.what = kind->what;
    if (std::string wrong = read_fields(object, *kind, message); !wrong.empty())
        return fault(message.id, std::move(wrong));
    return message;
}

std::string refusal_text(std::uint32_t id, std::string_view code, std::string_view sentence) {
    return "{\"id\": " + std::to_string(id) + ", \"ok\": false, \"code\": " + browser::in_quotes(code) +
           ", \"error\": " + browser::in_quotes(as_utf8(sentence)) + "}";
}

} // namespace tappet::network

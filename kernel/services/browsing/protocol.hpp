// The language between a browser and a running machine (thesis 4.8): requests as text, replies as JSON, over
// a local socket. Both ends read it here.
#pragma once

#include "kernel/base/bounded.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"
#include "kernel/machine/table/board.hpp"

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <string_view>

/// The socket is AF_UNIX, SOCK_SEQPACKET, at `<directory>/<machine>.socket`, the directory being the board's
/// ("/run/tappet") or the firmware's --browse. One packet is one request or one reply; a packet ends with a
/// line feed, which a sender may leave out.
///
/// A request is `NUMBER VERB ARGUMENT...`, words parted by blanks. NUMBER is the client's, 0 to 2^32-1, and
/// stands in everything that answers the request. A word with blanks is written in double quotes, where \"
/// and \\ stand for themselves; what stands in brackets ([1, 2], {p: 1}) is one word. Values are spelled as
/// kernel/base/value_text.hpp reads them: 4ms, 0.25, true, "text", [1, 2, 3].
///
/// Every request gets one reply, {"id": NUMBER, "ok": true, ...} or
/// {"id": NUMBER, "ok": false, "code": "...", "error": "sentence that names the cure"}; `code` is one of
/// refusal_codes. After the reply of `send` and `subscribe` there come packets without "ok":
///     {"id": N, "command": "shaft.stop", "state": "executing", "time_ns": T}
///         for each new state; with "final": true in the last, then with "results": [..] when the state is
///         "done";
///     {"id": N, "event": "shaft.beat_up", "time_ns": T, "arguments": [..], "lost": n}
///         n: emissions of this subscription that were lost so far.
/// A line of the script language is an expression, which any role may ask for, or statements, each with the
/// role that it takes to send, call or set what they name. It ends in one packet:
///     {"id": N, "line": "done", "time_ns": T, "final": true, "value": .. of an expression, "variables":
///     {"x": .. of statements}}
///     {"id": N, "line": "failed", "time_ns": T, "final": true, "error": "where and why"}
/// It is broken off when its client leaves.
/// A script comes in pieces, `script SLOT 0 "..."` and so on at the number of bytes that the last reply said;
/// `load` compiles it, answers its first error with file, line and column, and lets it take over at once, at
/// an event of the slot's reach or when the slot's angle is passed. `behaviours SLOT` tells what became of
/// it. What a client does not read is not kept for it: beyond its socket's buffer packets are dropped, and
/// the next that it gets says "dropped": n.
///
/// A packet of number 0 that is not "ok" comes before any request: no place was free, or one of a higher role
/// took this one. The connection ends after it.
///
/// Times are the machine's: nanoseconds of CLOCK_MONOTONIC on a box, virtual ones under virtual time.
namespace tappet::browsing {

inline constexpr std::uint32_t protocol_version = 1;
inline constexpr std::size_t max_packet_bytes = 4096;
inline constexpr std::size_t max_clients = 8;
inline constexpr std::size_t max_words = 64;
inline constexpr std::string_view default_directory = "/run/tappet";
inline constexpr std::string_view socket_suffix = ".socket";

using tappet::Role;
using tappet::to_text;

enum class Verb : std::uint8_t {
    hello,
    map,
    get,
    subscribe,
    unsubscribe,
    forced,
    counters,
    call,
    send,
    set,
    force,
    release,
    save,
    start,
    stop,
    restart,
    behaviours,
    why,
    behave,
    script,
    load,
    unload,
    roll_back,
    execute,
    break_off
};

struct VerbRow {
    Verb verb;
    std::string_view name;
    Role role; ///< the least that may ask for it
    std::string_view usage;
    std::size_t fewest; ///< arguments
    std::size_t most;
    std::string_view answer; ///< what stands in the reply beside id and ok
};

// clang-format off
inline constexpr auto verbs = std::to_array<VerbRow>({
    {Verb::hello,       "hello",       Role::observer,         "hello",                            0, 0,
     R"("protocol": 1, "machine": "...", "board": "...", "world": "...", "role": "...", "build_id": "...", "time_ns": T)"},
    {Verb::map,         "map",         Role::observer,         "map",                              0, 0,
     R"("bytes": n, and one file descriptor (SCM_RIGHTS), to be mapped read-only: kernel/machine/map/layout.hpp)"},
    {Verb::get,         "get",         Role::observer,         "get NAME...",                      1, max_words,
     R"("values": [{"name": "...", "value": .., "flow": "fresh|stale|never_written", "forced": true|false, "time_ns": T}])"},
    {Verb::subscribe,   "subscribe",   Role::observer,         "subscribe EVENT",                  1, 1, ""},
    {Verb::unsubscribe, "unsubscribe", Role::observer,         "unsubscribe EVENT",                1, 1, ""},
    {Verb::forced,      "forced",      Role::observer,         "forced",                           0, 0, R"("forced": ["NAME", ..])"},
    {Verb::counters,    "counters",    Role::observer,         "counters",                         0, 0,
     R"("stacks": [{"activity": "...", "bytes": n, "used_bytes": n, as deep as it went}], "held_back": [{"row": "...", "times": n, by rows of limits}])"},
    {Verb::call,        "call",        Role::machine_operator, "call METHOD [ARGUMENT...]",        1, max_words, R"("result": .. unless it returns nothing)"},
    {Verb::send,        "send",        Role::machine_operator, "send COMMAND [ARGUMENT...]",       1, max_words, R"("state": "sent"; packets with its states follow)"},
    {Verb::set,         "set",         Role::engineer,         "set NAME VALUE [NAME VALUE...]",   2, max_words, R"("set": n: all of one component and in one transaction, or none)"},
    {Verb::force,       "force",       Role::engineer,         "force PORT VALUE",                 2, 2, ""},
    {Verb::release,     "release",     Role::engineer,         "release PORT",                     1, 1, ""},
    {Verb::save,        "save",        Role::engineer,         "save [COMPONENT]",                 0, 1, R"("files": n, of so many components)"},
    {Verb::start,       "start",       Role::engineer,         "start COMPONENT|activity:NAME",         1, 1, ""},
    {Verb::stop,        "stop",        Role::engineer,         "stop COMPONENT|activity:NAME",          1, 1, ""},
    {Verb::restart,     "restart",     Role::engineer,         "restart COMPONENT|activity:NAME",       1, 1, ""},
    {Verb::behaviours,  "behaviours",  Role::observer,         "behaviours [NAME|SLOT]",           0, 1,
     R"("behaviours": [{"name": "component.instance", "kind": "machine|program", "status": "...", "state": "a/b", "line": n}], "slots": [{"slot": "component", "phase": "empty|steady|waiting|handing_over|trial", "script": "...", "loads": n, "roll_backs": n, "news": "..."}]; of one also "variables", "transitions", "left_over", "fault")"},
    {Verb::why,         "why",         Role::observer,         "why COMPONENT.STATE",              1, 1,
     R"("name": "component.instance", "status": "...", "state": "a/b", "wanted": "a/c", "is_final": true|false, "path": ["STATE", .. from leaf to leaf], "ways": [{"from": "b", "to": "c", "event": "...", "reason": "when it is taken", "answer": "open|too_early|guard|precondition|arguments|failed|elsewhere", "left_ns": n, "state": "of the precondition", "because": "...", "detail": "..."}])"},
    {Verb::behave,      "behave",      Role::engineer,         "behave start|stop|pause|step|reset|deactivate|reactive|request NAME [STATE]", 2, 3, ""},
    {Verb::script,      "script",      Role::engineer,         "script SLOT OFFSET TEXT",          3, 3, R"("bytes": n, of the script so far)"},
    {Verb::load,        "load",        Role::engineer,         "load SLOT FILE [now|EVENT|DEGREES]", 2, 3, ""},
    {Verb::unload,      "unload",      Role::engineer,         "unload SLOT",                      1, 1, ""},
    {Verb::roll_back,   "roll_back",   Role::engineer,         "roll_back SLOT",                   1, 1, ""},
    {Verb::execute,     "execute",     Role::observer,         "execute \"LINE\"",                 1, 1, R"("state": "sent"; a packet with its end follows)"},
    {Verb::break_off,   "break_off",   Role::machine_operator, "break_off",                        0, 0, ""},
});
// clang-format on

/// Why a request was refused; the sentence says more.
enum class Refusal : std::uint8_t {
    bad_request, ///< it cannot be read
    denied,      ///< the peer's role does not reach so far
    unknown,     ///< there is nothing of that name
    bad_value,   ///< of another type, out of range, or the component does not accept it
    not_now,     ///< in flight already, not running, no room: may be asked again
    unsupported  ///< this machine has none of it
};

constexpr std::string_view to_text(Refusal refusal) noexcept {
    switch (refusal) {
    case Refusal::bad_request: return "bad_request";
    case Refusal::denied: return "denied";
    case Refusal::unknown: return "unknown";
    case Refusal::bad_value: return "bad_value";
    case Refusal::not_now: return "not_now";
    case Refusal::unsupported: return "unsupported";
    }
    return "bad_request";
}

/// A request, read; its words point into the packet. A quoted word is without its outer quotes when it holds
/// no escape, and as it came otherwise.
struct Request {
    std::uint32_t number = 0;
    const VerbRow* verb = nullptr;
    Bounded<std::string_view, max_words> arguments{};
};

constexpr const VerbRow* find_verb(std::string_view name) noexcept {
    for (const VerbRow& row : verbs)
        if (row.name == name) return &row;
    return nullptr;
}

namespace detail {

constexpr bool is_blank(char character) noexcept {
    return character == ' ' || character == '\t' || character == '\n' || character == '\r';
}

/// Takes the next word off `rest`. False: a quote or a bracket is not closed. Empty when nothing is left.
constexpr bool take_word(std::string_view& rest, std::string_view& word) noexcept {
    std::size_t begin = 0;
    while (begin < rest.size() && is_blank(rest[begin])) ++begin;
    std::size_t end = begin;
    std::size_t depth = 0;
    bool quoted = false;
    for (; end < rest.size() && (quoted || depth > 0 || !is_blank(rest[end])); ++end) {
        const char character = rest[end];
        if (quoted) {
            if (character == '\\')
                ++end;
            else if (character == '"')
                quoted = false;
        } else if (character == '"') {
            quoted = true;
        } else if (character == '[' || character == '{' || character == '(') {
            ++depth;
        } else if ((character == ']' || character == '}' || character == ')') && depth > 0) {
            --depth;
        }
    }
    if (end > rest.size()) end = rest.size();
    word = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return !quoted && depth == 0;
}

} // namespace detail

/// Reads one packet, `text` outliving the request. An answer that is not empty says what is wrong; the number
/// is set as far as it could be read.
inline Sentence parse_request(std::string_view text, Request& request) noexcept {
    request = {};
    if (text.size() > max_packet_bytes)
        return Sentence{"a request has at most ", max_packet_bytes, " bytes; send several"};
    for (const char character : text)
        if (static_cast<unsigned char>(character) < 0x20 && !detail::is_blank(character))
            return Sentence{"a request holds a control character; requests are text"};
    std::string_view word;
    if (!detail::take_word(text, word)) return Sentence{"a quote or a bracket is not closed"};
    const auto number = std::from_chars(word.data(), word.data() + word.size(), request.number);
    if (word.empty() || number.ec != std::errc{} || number.ptr != word.data() + word.size())
        return Sentence{"a request begins with a number of the client's own; send \"1 hello\""};
    if (!detail::take_word(text, word)) return Sentence{"a quote or a bracket is not closed"};
    request.verb = find_verb(word);
    if (request.verb == nullptr) {
        Nearest nearest{word};
        for (const VerbRow& row : verbs) nearest.consider(row.name);
        Sentence sentence{"there is no request \"", word.substr(0, nearest_max_length), "\""};
        if (nearest.best().empty()) return sentence.add("; send one that protocol.hpp lists");
        return sentence.add("; did you mean \"").add(nearest.best()).add("\"?");
    }
    while (true) {
        if (!detail::take_word(text, word)) return Sentence{"a quote or a bracket is not closed"};
        if (word.empty()) break;
        const bool plain = word.size() >= 2 && word.front() == '"' && word.back() == '"' &&
                           word.find('\\') == std::string_view::npos && word.find('"', 1) == word.size() - 1;
        if (!request.arguments.push(plain ? word.substr(1, word.size() - 2) : word))
            return Sentence{"a request has at most ", max_words, " words; send several"};
    }
    if (request.arguments.size() < request.verb->fewest || request.arguments.size() > request.verb->most)
        return Sentence{"\"",
                        request.verb->name,
                        "\" was given ",
                        request.arguments.size(),
                        " arguments; it is spelled: ",
                        request.verb->usage};
    return {};
}

} // namespace tappet::browsing

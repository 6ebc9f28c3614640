// The language between a browser and a running machine (thesis 4.8): requests as text, replies as JSON, over
// a local socket. Both ends use this file.
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

/// The socket is AF_UNIX, SOCK_SEQPACKET, at `<directory>/<machine>.socket`; the directory is the board's
/// ("/run/tappet") or the firmware's --browse. One packet is one request or one reply; a packet ends with a
/// line feed, which a sender may omit.
///
/// A request is `NUMBER VERB ARGUMENT...`, words separated by blanks. The client chooses NUMBER, 0 to 2^32-1;
/// every answer to the request contains it. A word with blanks is written in double quotes, in which \" and
/// \\ are escapes; text in brackets ([1, 2], {p: 1}) is one word. kernel/base/value_text.hpp defines the
/// spelling of values: 4ms, 0.25, true, "text", [1, 2, 3].
///
/// Every request gets one reply, {"id": NUMBER, "ok": true, ...} or
/// {"id": NUMBER, "ok": false, "code": "...", "error": "sentence that names the cure"}; `code` is one of
/// refusal_codes. After the reply to `send` and `subscribe`, packets without "ok" follow:
///     {"id": N, "command": "shaft.stop", "state": "executing", "time_ns": T}
///         for each new state; with "final": true in the last, then with "results": [..] when the state is
///         "done";
///     {"id": N, "event": "shaft.beat_up", "time_ns": T, "arguments": [..], "lost": n}
///         n: the emissions of this subscription that were lost so far.
/// A line of the script language is an expression, which any role may evaluate, or statements, each with the
/// role that sending, calling or setting their names needs. It ends with one packet:
///     {"id": N, "line": "done", "time_ns": T, "final": true, "value": .. of an expression, "variables":
///     {"x": .. of statements}}
///     {"id": N, "line": "failed", "time_ns": T, "final": true, "error": "where and why"}
/// It is broken off when its client leaves.
/// A script is sent in pieces, `script SLOT 0 "..."` and so on, each at the number of bytes in the last
/// reply. `load` compiles it, answers its first error with file, line and column, and lets it take over at
/// once, at an event of the slot's reach or when the slot's angle is passed. `behaviours SLOT` reports the
/// result. Packets that a client does not read are not kept: beyond its socket's buffer they are dropped, and
/// the next packet that it gets says "dropped": n.
///
/// A connection may begin with `as`: it asks for the user of that name, with the lowest of three roles: its
/// own by the board, the bound of its gateway row, and ROLE. The name stands in each line of the log. This
/// cannot be changed or undone, and only `hello` may come before it. A connection of a peer that the board
/// lists as a gateway must begin so. Over the network nobody may call, send or execute what its interface
/// does not mark for_people(..), or marks `moves` or `moves_while_held`.
///
/// A packet of number 0 that is not "ok" may come before any request: no place was free, or a client of a
/// higher role took this one. Then the connection ends.
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

// clang-format off
/// A request is one row here and its function, BrowserService::serve_NAME, in the requests_*.cpp of its kind.
/// Columns: name; lowest role; minimum and maximum number of arguments, and their spelling; contents of the
/// reply beside id and ok. The further columns make it a command of tappet-browse too: the kind of its names
/// (Takes of commands.hpp), its help, and its usage where people spell it differently.
#define TAPPET_REQUESTS(X) \
    X(hello,       observer,         0, 0,         "", \
      R"("protocol": 1, "machine": "...", "board": "...", "world": "...", "role": "...", "build_id": "...", "framework": "0.15", "time_ns": T)") \
    X(as,          observer,         3, 3,         " NAME ROLE network|panel", R"("role": "the one that it now has")") \
    X(map,         observer,         0, 0,         "", \
      R"("bytes": n, and one file descriptor (SCM_RIGHTS), to be mapped read-only: kernel/machine/map/layout.hpp)") \
    X(get,         observer,         1, browsing::max_words, " NAME...", \
      R"("values": [{"name": "...", "value": .., "flow": "fresh|stale|never_written|unread", "forced": true|false, "time_ns": T}])") \
    X(subscribe,   observer,         1, 1,         " EVENT", "") \
    X(unsubscribe, observer,         1, 1,         " EVENT", "") \
    X(forced,      observer,         0, 0,         "", R"("forced": ["NAME", ..])") \
    X(counters,    observer,         0, 0,         "", \
      R"("stacks": [{"activity": "...", "bytes": n, "used_bytes": n, as deep as it went}], "held_back": [{"row": "...", "times": n, by rows of limits}], "unsent": [{"input": "..." or "output" of a driver: received, "clamped": n, "no_number": n, the first 16}], "unsent_rows": n, of all})") \
    X(call,        machine_operator, 1, browsing::max_words, " METHOD [ARGUMENT...]", R"("result": .. unless it returns nothing)", \
      callable, "a method or an operation, answered at once (operator)") \
    X(send,        machine_operator, 1, browsing::max_words, " COMMAND [ARGUMENT...]", R"("state": "sent"; packets with its states follow)", \
      command, "a command; --follow: prints its states until it is finished (operator)", "send COMMAND [ARGUMENT...] [--follow]") \
    X(set,         engineer,         2, browsing::max_words, " NAME VALUE [NAME VALUE...]", R"("set": n: all of one component and in one transaction, or none)", \
      property, "properties of one component, all at once or none (engineer)", "set PROPERTY VALUE [PROPERTY VALUE...]") \
    X(force,       engineer,         2, 2,         " PORT VALUE", "", port, "a port has this value whatever is written to it (engineer)") \
    X(release,     engineer,         1, 1,         " PORT", "", port, "ends what force began (engineer)") \
    X(save,        engineer,         0, 1,         " [COMPONENT]", R"("files": n, of so many components)", component, "writes properties to their files (engineer)") \
    X(start,       engineer,         1, 1,         " COMPONENT|activity:NAME", "", component_or_activity, "starts what was stopped (engineer)", "start COMPONENT|ACTIVITY") \
    X(stop,        engineer,         1, 1,         " COMPONENT|activity:NAME", "", component_or_activity, "stops it; it leaves safe values (engineer)", "stop COMPONENT|ACTIVITY") \
    X(restart,     engineer,         1, 1,         " COMPONENT|activity:NAME", "", component_or_activity, "stops and starts it (engineer)", "restart COMPONENT|ACTIVITY") \
    X(behaviours,  observer,         0, 1,         " [NAME|SLOT]", \
      R"("behaviours": [{"name": "component.instance", "kind": "machine|program", "status": "...", "state": "a/b", "line": n}], "slots": [{"slot": "component", "phase": "empty|steady|waiting|handing_over|trial", "script": "...", "loads": n, "roll_backs": n, "news": "..."}]; of one also "variables", "transitions", "left_over", "fault")") \
    X(why,         observer,         1, 1,         " COMPONENT.STATE", \
      R"("name": "component.instance", "status": "...", "state": "a/b", "wanted": "a/c", "is_final": true|false, "path": ["STATE", .. from leaf to leaf], "ways": [{"from": "b", "to": "c", "event": "...", "reason": "when it is taken", "answer": "open|too_early|guard|precondition|arguments|failed|elsewhere", "left_ns": n, "state": "of the precondition", "because": "...", "detail": "..."}])", \
      nothing, "why its state machine is not in that state: the transitions that lead nearer, the events they await, the guards that refuse and their reasons") \
    X(behave,      engineer,         2, 3,         " start|stop|pause|step|reset|deactivate|reactive|request NAME [STATE]", "") \
    X(script,      engineer,         3, 3,         " SLOT OFFSET TEXT", R"("bytes": n, of the script so far)") \
    X(load,        engineer,         2, 3,         " SLOT FILE [now|EVENT|DEGREES]", "") \
    X(unload,      engineer,         1, 1,         " SLOT", "") \
    X(roll_back,   engineer,         1, 1,         " SLOT", "") \
    X(execute,     observer,         1, 1,         " \"LINE\"", R"("state": "sent"; a packet with its end follows)") \
    X(break_off,   machine_operator, 0, 0,         "", "")
// clang-format on

/// The machine's data of a request before it serves it.
struct VerbRow {
    std::string_view name;
    Role role;
    std::string_view usage;
    std::size_t fewest; ///< arguments
    std::size_t most;
};

#define TAPPET_X(name, role, fewest, most, arguments, ...) {#name, Role::role, #name arguments, fewest, most},
inline constexpr auto verbs = std::to_array<VerbRow>({TAPPET_REQUESTS(TAPPET_X)});
#undef TAPPET_X

/// The code of a refusal; the sentence says more.
enum class Refusal : std::uint8_t {
    bad_request, ///< it cannot be parsed
    denied,      ///< the peer's role is too low
    unknown,     ///< no such name
    bad_value,   ///< wrong type, out of range, or the component refuses it
    not_now,     ///< in progress already, not running, no room: may be tried again
    unsupported  ///< not available in this machine
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

/// A parsed request; its words point into the packet. A quoted word without escapes is stored without its
/// outer quotes; a word with escapes is stored unchanged.
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

/// Takes the next word off `rest`. False: a quote or a bracket is not closed. The word is empty when nothing
/// is left.
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

/// Parses one packet; `text` must outlive the request. An answer that is not empty states the fault; the
/// number is set if it could be parsed.
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

// One line of the browser, from a shell or typed: its words and its options.
#pragma once

#include "kernel/services/browsing/protocol.hpp"

#include <chrono>
#include <expected>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tappet::browser {

struct Line {
    std::vector<std::string> words{}; ///< the command, if any, and its arguments
    bool json = false;                ///< one JSON object a line
    bool follow = false;              ///< send: until the command has ended
    bool stop = false;                ///< execute: breaks off the line at work
    bool help = false;
    std::vector<std::string> given{};     ///< options, as written
    std::string at{};                     ///< behaviour load: an event or an angle; empty: at once
    std::string to{};                     ///< scope: the output file; empty: none
    std::chrono::milliseconds length{};   ///< scope record: duration; 0: the default
    long count = 0;                       ///< of pictures or events; 0: no limit
    std::chrono::milliseconds every{200}; ///< between two pictures
    std::chrono::milliseconds patience{3000};
    std::vector<std::string> sockets{}; ///< [NAME=]FILE; empty: those in `directory`
    std::string directory{browsing::default_directory};
};

/// `goes_to` receives the value of the option; a bool has none.
struct Option {
    std::string_view name;
    std::variant<bool Line::*, std::string Line::*, std::vector<std::string> Line::*, long Line::*,
                 std::chrono::milliseconds Line::*>
        goes_to;
    bool of_all = false; ///< for all commands; otherwise for those whose usage has it
};

[[nodiscard]] std::span<const Option> options();
/// Options may stand anywhere; after "--" everything is a word. The error states the fault and the cure.
[[nodiscard]] std::expected<Line, std::string> parse_line(std::span<const std::string> words);
/// Splits a typed line into words as in a request: quotes and brackets protect blanks.
[[nodiscard]] std::expected<std::vector<std::string>, std::string> split_line(std::string_view text);
/// "200ms", "1.5s", "2s"; a bare number is milliseconds.
[[nodiscard]] std::expected<std::chrono::milliseconds, std::string> parse_time(std::string_view text);

} // namespace tappet::browser

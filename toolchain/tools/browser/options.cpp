// Parses a line: options are few, the same for every command, and never taken for a value.
#include "toolchain/tools/browser/options.hpp"

#include "kernel/base/nearest.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace tappet::browser {

namespace {

constexpr auto rows = std::to_array<Option>({{"--json", &Line::json, true},
                                             {"--follow", &Line::follow},
                                             {"--help", &Line::help, true},
                                             {"--count", &Line::count},
                                             {"--every", &Line::every},
                                             {"--at", &Line::at},
                                             {"--socket", &Line::sockets, true},
                                             {"--timeout", &Line::patience, true},
                                             {"--directory", &Line::directory, true},
                                             {"--for", &Line::length},
                                             {"--to", &Line::to},
                                             {"--stop", &Line::stop}});

bool is_number(std::string_view text) {
    const std::string_view rest = text.substr(std::min(text.find_first_not_of('-'), text.size()));
    return !rest.empty() && (rest[0] == '.' || (rest[0] >= '0' && rest[0] <= '9'));
}

std::string unknown(std::string_view word) {
    Nearest nearest{word};
    for (const Option& each : rows) nearest.consider(each.name);
    const std::string what = "there is no option " + std::string{word};
    if (nearest.best().empty()) return what + "; --help lists them";
    return what + "; did you mean " + std::string{nearest.best()} + "?";
}

/// Returns what is wrong with the value; empty: nothing.
std::string take(Line& line, const Option& option, const std::string& value) {
    if (const auto* const text = std::get_if<std::string Line::*>(&option.goes_to)) {
        line.*(*text) = value;
    } else if (const auto* const list = std::get_if<std::vector<std::string> Line::*>(&option.goes_to)) {
        (line.*(*list)).push_back(value);
    } else if (const auto* const number = std::get_if<long Line::*>(&option.goes_to)) {
        const char* const stop = value.data() + value.size();
        const auto [end, error] = std::from_chars(value.data(), stop, line.*(*number));
        if (error != std::errc{} || end != stop || line.*(*number) < 1)
            return std::string{option.name} + " takes a number from 1, not '" + value + "'";
    } else {
        const auto time = parse_time(value);
        if (!time) return std::string{option.name} + ": " + time.error();
        line.*std::get<std::chrono::milliseconds Line::*>(option.goes_to) = *time;
    }
    return {};
}

} // namespace

std::span<const Option> options() { return rows; }

std::expected<std::chrono::milliseconds, std::string> parse_time(std::string_view text) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    const std::string_view unit{at, static_cast<std::size_t>(end - at)};
    const double factor = unit == "s" ? 1000.0 : unit == "ms" || unit.empty() ? 1.0 : 0.0;
    const double milliseconds = value * factor;
    if (error != std::errc{} || factor == 0.0 || !(milliseconds >= 1.0) || milliseconds > 86'400'000.0)
        return std::unexpected("'" + std::string{text} +
                               "' is not a time from 1ms to 86400s; write 200ms or 2s");
    return std::chrono::milliseconds{static_cast<std::int64_t>(milliseconds)};
}

std::expected<Line, std::string> parse_line(std::span<const std::string> words) {
    Line line;
    bool options_end = false;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (options_end || !word.starts_with("--") || is_number(word)) {
            line.words.push_back(word);
            continue;
        }
        if (word == "--") {
            options_end = true;
            continue;
        }
        const auto* const option = std::ranges::find(rows, word, &Option::name);
        if (option == rows.end()) return std::unexpected(unknown(word));
        line.given.push_back(word);
        if (const auto* const flag = std::get_if<bool Line::*>(&option->goes_to)) {
            line.*(*flag) = true;
            continue;
        }
        if (i + 1 == words.size())
            return std::unexpected(word + " needs a value after it; --help shows which");
        if (std::string fault = take(line, *option, words[++i]); !fault.empty())
            return std::unexpected(std::move(fault));
    }
    return line;
}

std::expected<std::vector<std::string>, std::string> split_line(std::string_view text) {
    std::vector<std::string> words;
    for (std::string_view word;;) {
        if (!browsing::detail::take_word(text, word))
            return std::unexpected(std::string{"a quote or a bracket is not closed"});
        if (word.empty()) return words;
        words.emplace_back(word);
    }
}

} // namespace tappet::browser

// Reading a line: options are few, the same for every command, and never taken for a value.
#include "toolchain/tools/browser/options.hpp"

#include "kernel/base/nearest.hpp"

#include <array>
#include <charconv>

namespace tappet::browser {

namespace {

constexpr std::array<std::string_view, 12> names{"--json",      "--follow", "--help",   "--count",
                                                 "--every",     "--at",     "--socket", "--timeout",
                                                 "--directory", "--for",    "--to",     "--stop"};

bool is_number(std::string_view text) {
    const std::string_view rest = text.substr(
        text.find_first_not_of('-') == std::string_view::npos ? text.size() : text.find_first_not_of('-'));
    return !rest.empty() && (rest[0] == '.' || (rest[0] >= '0' && rest[0] <= '9'));
}

std::string unknown(std::string_view word) {
    Nearest nearest{word};
    for (const std::string_view name : names) nearest.consider(name);
    const std::string what = "there is no option " + std::string{word};
    if (nearest.best().empty()) return what + "; --help lists them";
    return what + "; did you mean " + std::string{nearest.best()} + "?";
}

} // namespace

std::span<const std::string_view> option_names() { return names; }

std::expected<std::chrono::milliseconds, std::string> parse_time(std::string_view text) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    const std::string_view unit{at, static_cast<std::size_t>(end - at)};
    const double factor = unit == "s" ? 1000.0 : unit == "ms" || unit.empty() ? 1.0 : 0.0;
    const double milliseconds = value * factor;
    if (error != std::errc{} || factor == 0.0 || !(milliseconds >= 1.0) || milliseconds > 86'400'000.0)
        return std::unexpected("'" + std::string{text} +
                               "' is no time from 1ms to 86400s; write 200ms or 2s");
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
        if (word == "--json" || word == "--follow" || word == "--help" || word == "--stop") {
            line.given.push_back(word);
            (word == "--json"     ? line.json
             : word == "--follow" ? line.follow
             : word == "--stop"   ? line.stop
                                  : line.help) = true;
            continue;
        }
        line.given.push_back(word);
        bool known = false;
        for (const std::string_view name : names) known = known || name == word;
        if (!known) return std::unexpected(unknown(word));
        if (i + 1 == words.size())
            return std::unexpected(word + " needs a value after it; --help shows which");
        const std::string& value = words[++i];
        if (word == "--at") {
            line.at = value;
        } else if (word == "--to") {
            line.to = value;
        } else if (word == "--socket") {
            line.sockets.push_back(value);
        } else if (word == "--directory") {
            line.directory = value;
        } else if (word == "--count") {
            const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), line.count);
            if (error != std::errc{} || end != value.data() + value.size() || line.count < 1)
                return std::unexpected("--count takes a number from 1, not '" + value + "'");
        } else {
            const auto time = parse_time(value);
            if (!time) return std::unexpected(word + ": " + time.error());
            (word == "--every" ? line.every : word == "--for" ? line.length : line.patience) = *time;
        }
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

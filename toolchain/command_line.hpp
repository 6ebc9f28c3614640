// A program's options as one table: for parsing, for --help, and for the shell's completion.
#pragma once

#include <cstdint>
#include <expected>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tappet {

struct Option {
    std::string_view name;    ///< "--for"
    std::string_view value{}; ///< the word after it: "SECONDS"; empty: none
    std::string_view help{};
    bool is_number = false; ///< a whole number
    std::uint64_t least = 0;
    std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
};

/// How a program treats words that are no option of its table.
enum class Others : std::uint8_t {
    refused,
    words,  ///< words that do not begin with - are arguments
    options ///< they are another program's options, each with a value
};

/// The parsed words, as views of the given ones.
struct CommandLine {
    std::vector<std::pair<const Option*, std::string_view>> options{};
    std::vector<std::string_view> words{};
    std::vector<std::pair<std::string_view, std::string_view>> of_others{};

    [[nodiscard]] bool has(std::string_view option) const;
    /// Returns the last value given.
    [[nodiscard]] std::string_view text(std::string_view option, std::string_view otherwise = {}) const;
    [[nodiscard]] std::uint64_t number(std::string_view option, std::uint64_t otherwise) const;
};

/// Parses a command line. `kinds`: the allowed words beside options, if they are limited. The error names the
/// first wrong word, and the cure. Not real-time.
[[nodiscard]] std::expected<CommandLine, std::string>
read_command_line(std::span<const Option> table, std::span<const std::string_view> words, Others others,
                  std::span<const Option> kinds = {});

/// Returns one line per option.
[[nodiscard]] std::string usage_of(std::span<const Option> table);

/// Returns "; did you mean build?", or `otherwise` when no name is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> names,
                                       std::string_view otherwise = {});

} // namespace tappet

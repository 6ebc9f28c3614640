// A program's options as one table: what it takes, what it prints for --help and what a shell completes.
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
    std::string_view value{}; ///< what stands after it: "SECONDS"; empty: nothing
    std::string_view help{};
    bool is_number = false; ///< a whole number
    std::uint64_t least = 0;
    std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
};

/// What a program does with words that are no option of its table.
enum class Others : std::uint8_t {
    refused,
    words,  ///< those that do not begin with - stand for themselves
    options ///< they are options of somebody else, each with a value
};

/// Views of the words that were read.
struct CommandLine {
    std::vector<std::pair<const Option*, std::string_view>> options{};
    std::vector<std::string_view> words{};
    std::vector<std::pair<std::string_view, std::string_view>> of_others{};

    [[nodiscard]] bool has(std::string_view option) const;
    /// As it was given last.
    [[nodiscard]] std::string_view text(std::string_view option, std::string_view otherwise = {}) const;
    [[nodiscard]] std::uint64_t number(std::string_view option, std::uint64_t otherwise) const;
};

/// Not real-time. `kinds`: of words that stand for themselves, if they are limited. The error is what is
/// wrong with the first bad word, and the cure.
[[nodiscard]] std::expected<CommandLine, std::string>
read_command_line(std::span<const Option> table, std::span<const std::string_view> words, Others others,
                  std::span<const Option> kinds = {});

/// A line for each option.
[[nodiscard]] std::string usage_of(std::span<const Option> table);

/// "; did you mean build?", or `otherwise` when none is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> names,
                                       std::string_view otherwise = {});

} // namespace tappet

// Parses command lines and writes their help.
#include "toolchain/command_line.hpp"

#include "kernel/base/nearest.hpp"

#include <algorithm>
#include <charconv>

namespace tappet {

namespace {

/// Returns what is wrong with the word; empty when it is a value of the option.
std::string fault_in(const Option& option, std::string_view word) {
    if (!option.is_number) return {};
    const std::string head = "option " + std::string{option.name} + ": \"" + std::string{word} + "\" is not ";
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size())
        return head + "a whole number; write for example " + std::string{option.name} + " 60";
    if (value < option.least || value > option.most)
        return head + "from " + std::to_string(option.least) + " to " + std::to_string(option.most);
    return {};
}

std::vector<std::string_view> names_of(std::span<const Option> table) {
    std::vector<std::string_view> names;
    for (const Option& each : table) names.push_back(each.name);
    return names;
}

} // namespace

bool CommandLine::has(std::string_view option) const {
    return std::ranges::any_of(options, [&](const auto& each) { return each.first->name == option; });
}

std::string_view CommandLine::text(std::string_view option, std::string_view otherwise) const {
    for (const auto& [known, value] : options)
        if (known->name == option) otherwise = value;
    return otherwise;
}

std::uint64_t CommandLine::number(std::string_view option, std::uint64_t otherwise) const {
    const std::string_view word = text(option);
    if (!word.empty()) std::from_chars(word.data(), word.data() + word.size(), otherwise);
    return otherwise;
}

std::expected<CommandLine, std::string> read_command_line(std::span<const Option> table,
                                                          std::span<const std::string_view> words,
                                                          Others others, std::span<const Option> kinds) {
    const auto unknown = [](const char* what, std::string_view word, std::span<const Option> known) {
        return std::unexpected(what + std::string{word} + " is unknown" +
                               did_you_mean(word, names_of(known), "; see --help"));
    };
    CommandLine line;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string_view word = words[i];
        const auto known = std::ranges::find(table, word, &Option::name);
        if (known == table.end()) {
            if (others == Others::words && !word.starts_with("-")) {
                if (!kinds.empty() && std::ranges::find(kinds, word, &Option::name) == kinds.end())
                    return unknown("word ", word, kinds);
                line.words.push_back(word);
                continue;
            }
            if (others != Others::options || i + 1 == words.size()) return unknown("option ", word, table);
            line.of_others.emplace_back(word, words[++i]);
            continue;
        }
        if (known->value.empty()) {
            line.options.emplace_back(&*known, std::string_view{});
            continue;
        }
        if (i + 1 == words.size())
            return std::unexpected("option " + std::string{word} + " needs a value after it; see --help");
        if (std::string fault = fault_in(*known, words[++i]); !fault.empty()) return std::unexpected(fault);
        line.options.emplace_back(&*known, words[i]);
    }
    return line;
}

std::string usage_of(std::span<const Option> table) {
    constexpr std::size_t column = 20;
    std::string text;
    for (const Option& each : table) {
        std::string head{each.name};
        if (!each.value.empty()) head += " " + std::string{each.value};
        head.resize(std::max(column, head.size() + 1), ' ');
        text += "  " + head + std::string{each.help} + "\n";
    }
    return text;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> names,
                         std::string_view otherwise) {
    Nearest nearest{word};
    for (const std::string_view name : names) nearest.consider(name);
    return nearest.best().empty() ? std::string{otherwise}
                                  : "; did you mean " + std::string{nearest.best()} + "?";
}

} // namespace tappet

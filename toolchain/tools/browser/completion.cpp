// Completion by the table of commands and the machine's own map.
#include "toolchain/tools/browser/completion.hpp"

#include <algorithm>

namespace tappet::browser {

namespace {

/// Returns the names of all machines that answered before, and the machines' names when there are several.
std::vector<std::string> names_in(Machines& machines, const Command& command,
                                  std::span<const std::string> arguments) {
    std::vector<std::string> names;
    const bool may_be_machine = machines.are_several() && arguments.empty() && command.among != Among::values;
    for (const Machine& each : machines.all()) {
        if (may_be_machine) names.push_back(each.name);
        if (each.session == nullptr) continue;
        if (command.names != Names::none && !is_name(command, arguments, arguments.size())) continue;
        for (std::string& name : names_for(each.session->map(), command.takes))
            names.push_back(std::move(name));
    }
    return names;
}

} // namespace

std::string Completion::common() const {
    if (candidates.empty()) return {};
    std::string_view same = candidates.front();
    for (const std::string& each : candidates)
        same = same.substr(0, static_cast<std::size_t>(std::ranges::mismatch(same, each).in1 - same.begin()));
    return std::string{same};
}

Completion complete(Machines& machines, std::string_view before_cursor) {
    Completion completion;
    const std::size_t blank = before_cursor.find_last_of(" \t");
    completion.begin = blank == std::string_view::npos ? 0 : blank + 1;
    const std::string_view typed = before_cursor.substr(completion.begin);
    std::vector<std::string> names;
    if (typed.starts_with("-")) {
        for (const Option& each : options()) names.emplace_back(each.name);
    } else {
        const auto words = split_line(before_cursor.substr(0, completion.begin));
        std::vector<std::string> before;
        if (words)
            for (const std::string& word : *words)
                if (!word.starts_with("--")) before.push_back(word);
        if (before.empty()) {
            for (const Command& each : commands()) names.emplace_back(each.name);
            for (const char* own : {"help", "quit"}) names.emplace_back(own);
        } else if (before.front() == "help") {
            for (const Command& each : commands()) names.emplace_back(each.name);
        } else if (const Command* command = find_command(before.front());
                   command != nullptr && before.size() <= command->most + (machines.are_several() ? 1 : 0)) {
            names = names_in(machines, *command, std::span{before}.subspan(1));
        }
    }
    for (std::string& name : names)
        if (name.starts_with(typed)) completion.candidates.push_back(std::move(name));
    std::ranges::sort(completion.candidates);
    return completion;
}

} // namespace tappet::browser

// Completes words for a shell.
#include "toolchain/tools/front/commands.hpp"
#include "toolchain/tools/front/project.hpp"

#include <algorithm>

namespace tappet::front {

namespace {

void add(Words& candidates, std::span<const Option> table) {
    for (const Option& each : table) candidates.emplace_back(each.name);
}

} // namespace

Words completions(std::span<const Command> commands, const Words& words) {
    const std::string begun = words.empty() ? "" : words.back();
    Words candidates;
    const auto command =
        words.empty() ? commands.end() : std::ranges::find(commands, words[0], &Command::name);
    const auto machines = machines_of("CMakeLists.txt");
    if (words.size() < 2) {
        for (const Command& each : commands) candidates.emplace_back(each.name);
        candidates.emplace_back("--help");
    } else if (command != commands.end() && !command->passes_on) {
        const auto before = std::ranges::find(command->options, words[words.size() - 2], &Option::name);
        if (before != command->options.end() && !before->value.empty()) {
            if (before->name == "--machine" && machines) candidates = *machines;
        } else if (begun.starts_with("-")) {
            add(candidates, command->options);
            if (std::ranges::find(candidates, "--help") == candidates.end())
                candidates.emplace_back("--help");
        } else if (command->name == "build" && machines) {
            for (const std::string& machine : *machines)
                for (const char* target : {"", "-bench", "-plant", "-chart", "_test"})
                    candidates.push_back(machine + target);
        } else {
            add(candidates, command->kinds);
        }
    }
    std::erase_if(candidates, [&](const std::string& each) { return !each.starts_with(begun); });
    return candidates;
}

} // namespace tappet::front

// SPDX-License-Identifier: Apache-2.0
// Matches devices with modules, and loads these.
#include "board/box/modules.hpp"

#include <algorithm>

#include <dirent.h>
#include <fnmatch.h>

namespace tappet::box {

namespace {

void collect(const std::string& folder, std::vector<std::string>& aliases) {
    DIR* const open = ::opendir(folder.c_str());
    if (open == nullptr) return;
    std::vector<std::string> below;
    while (const dirent* entry = ::readdir(open)) {
        const std::string_view name = entry->d_name;
        if (entry->d_type == DT_DIR && name[0] != '.' && name != "power")
            below.push_back(folder + "/" + entry->d_name);
        else if (name == "modalias")
            if (std::string alias = init::read_line(folder + "/modalias"); !alias.empty())
                aliases.push_back(std::move(alias));
    }
    ::closedir(open);
    for (const std::string& each : below) collect(each, aliases);
}

} // namespace

std::vector<std::string> device_aliases(const std::string& folder) {
    std::vector<std::string> aliases;
    collect(folder, aliases);
    std::ranges::sort(aliases);
    const auto [first, last] = std::ranges::unique(aliases);
    aliases.erase(first, last);
    return aliases;
}

Modules::Modules(std::string_view table) {
    const Facts facts{table};
    for (const Words& line : facts.lines()) {
        if (line.size() < 2) continue;
        if (line[0].ends_with("module")) {
            Module& module = modules_.emplace_back();
            module.is_later = line[0].starts_with("later");
            module.name = line[1];
            for (std::size_t i = 2; i < line.size(); ++i) module.parameters += (i > 2 ? " " : "") + line[i];
        } else if (!modules_.empty()) {
            (line[0] == "needs" ? modules_.back().needs : modules_.back().aliases).push_back(line[1]);
        }
    }
}

Modules::Module* Modules::find(std::string_view name) {
    const auto found = std::ranges::find(modules_, name, &Module::name);
    return found == modules_.end() ? nullptr : &*found;
}

int Modules::loaded() const {
    return static_cast<int>(std::ranges::count(modules_, true, &Module::is_loaded));
}

init::Done Modules::load(Module& module) {
    if (module.is_loaded) return {};
    for (const std::string& needed : module.needs)
        if (Module* const other = find(needed); other != nullptr)
            if (auto done = load(*other); !done) return done;
    auto done = init::load_module("/modules/" + module.name + ".ko", module.parameters, signature_);
    module.is_loaded = done.has_value();
    return done;
}

std::expected<int, std::string> Modules::load_what_fits(Which which) {
    const int before = loaded();
    const std::vector<std::string> devices = device_aliases();
    std::string refused;
    for (Module& module : modules_) {
        if (module.is_later && which == Which::to_arm) continue;
        const bool fits = std::ranges::any_of(module.aliases, [&](const std::string& pattern) {
            if (pattern == "always") return true;
            return std::ranges::any_of(devices, [&](const std::string& device) {
                return ::fnmatch(pattern.c_str(), device.c_str(), 0) == 0;
            });
        });
        if (!fits || module.was_refused) continue; // one refusal is final, since the hardware does not change
        const auto done = load(module);
        module.was_refused = !done;
        if (!done && refused.empty()) refused = done.error();
    }
    if (!refused.empty()) return std::unexpected(refused);
    return loaded() - before;
}

} // namespace tappet::box

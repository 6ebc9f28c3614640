// SPDX-License-Identifier: Apache-2.0
// Reads modules.dep, modules.alias and modules.builtin, as depmod writes them.
#include "toolchain/tools/image/kernel_modules.hpp"

#include "toolchain/tools/image/tool.hpp"

#include <algorithm>
#include <set>
#include <sstream>

namespace tappet::image {

namespace fs = std::filesystem;

namespace {

/// Maps - to _: the kernel treats them as the same.
std::string plain(std::string name) {
    std::ranges::replace(name, '-', '_');
    return name;
}

std::string name_of(const std::string& path) { return plain(fs::path{path}.stem().string()); }

struct Known {
    fs::path file{};
    std::vector<std::string> needs{};
    std::vector<std::string>
        wants{}; ///< by name, or by an alias that they offer; the kernel would ask modprobe for them
    std::vector<std::string> devices{};
    std::vector<std::string> offers{};
};

class Tables {
public:
    explicit Tables(const fs::path& tree) {
        std::istringstream dependencies{read_file(tree / "modules.dep")};
        for (std::string line; std::getline(dependencies, line);) {
            std::istringstream words{line};
            std::string path;
            words >> path;
            path.pop_back(); // the colon
            Known& module = known_[name_of(path)];
            module.file = tree / path;
            for (std::string other; words >> other;) module.needs.push_back(name_of(other));
        }
        std::istringstream aliases{read_file(tree / "modules.alias")};
        for (std::string line; std::getline(aliases, line);) {
            std::istringstream words{line};
            std::string word, pattern, module;
            if (!(words >> word >> pattern >> module) || word != "alias" || !find(module)) continue;
            // A device alias has a bus before a colon. These boxes have no device tree.
            if (pattern.starts_with("of:")) continue;
            Known& of = known_.at(plain(module));
            (pattern.contains(':') ? of.devices : of.offers).push_back(pattern);
        }
        std::istringstream soft{read_file(tree / "modules.softdep")};
        for (std::string line; std::getline(soft, line);) {
            std::istringstream words{line};
            std::string word, module;
            if (!(words >> word >> module) || word != "softdep" || !find(module)) continue;
            for (bool before = false; words >> word;) {
                if (word.ends_with(':'))
                    before = word == "pre:";
                else if (before)
                    known_.at(plain(module)).wants.push_back(word);
            }
        }
        std::istringstream built_in{read_file(tree / "modules.builtin")};
        for (std::string line; std::getline(built_in, line);) built_in_.insert(name_of(line));
    }

    [[nodiscard]] bool is_built_in(const std::string& name) const { return built_in_.contains(plain(name)); }
    [[nodiscard]] const Known* find(const std::string& name) const {
        const auto found = known_.find(plain(name));
        return found == known_.end() ? nullptr : &found->second;
    }
    /// Adds the modules required by a module, each before those that need it.
    void order(const std::string& name, std::vector<std::string>& before) const {
        const Known& module = known_.at(name);
        const auto add = [&](const std::string& other) {
            if (std::ranges::find(before, other) != before.end()) return;
            order(other, before);
            before.push_back(other);
        };
        for (const std::string& other : module.needs) add(other);
        for (const std::string& other : module.wants)
            if (const std::string offering = who_offers(other); !offering.empty()) add(offering);
    }

private:
    /// Returns the module that offers it; among several, the one that every processor can run.
    [[nodiscard]] std::string who_offers(const std::string& wanted) const {
        if (find(wanted) != nullptr) return plain(wanted);
        for (const auto& [name, module] : known_)
            if (module.devices.empty() && std::ranges::find(module.offers, wanted) != module.offers.end())
                return name;
        return {};
    }

    std::map<std::string, Known> known_{};
    std::set<std::string> built_in_{};
};

} // namespace

KernelModules choose_modules(const std::vector<std::string>& rows, const std::vector<std::string>& later,
                             const fs::path& tree) {
    const Tables tables{tree};
    KernelModules chosen;
    std::vector<std::string> others;
    const auto add = [&](const std::string& name, const std::string& parameters, const char* when) {
        std::vector<std::string> before;
        tables.order(name, before);
        chosen.table += when + name + parameters + "\n";
        for (const std::string& each : before) chosen.table += "needs " + each + "\n";
        others.insert(others.end(), before.begin(), before.end());
        chosen.files[name] = tables.find(name)->file;
    };
    const auto take = [&](const std::string& row, const char* when) {
        const std::size_t blank = std::min(row.find(' '), row.size());
        const std::string name = plain(row.substr(0, blank));
        if (tables.is_built_in(name)) return;
        const Known* const module = tables.find(name);
        if (module == nullptr)
            throw Fault(
                "the kernel " + tree.filename().string() + " has no module \"" + row.substr(0, blank) +
                "\"; correct the board's kernel_modules(..), or add its folder to box_modules in ci/setup");
        add(name, row.substr(blank), when);
        for (const std::string& pattern : module->devices) chosen.table += "alias " + pattern + "\n";
        if (module->devices.empty()) chosen.table += "alias always\n";
    };
    for (const std::string& row : rows) take(row, "module ");
    for (const std::string& row : later) take(row, "later-module ");
    const std::set<std::string> unnamed{others.begin(), others.end()};
    for (const std::string& name : unnamed)
        if (!chosen.files.contains(name))
            add(name, {}, "module "); // else it has its own row, perhaps with parameters
    return chosen;
}

} // namespace tappet::image

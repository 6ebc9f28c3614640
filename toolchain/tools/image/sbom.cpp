// SPDX-License-Identifier: Apache-2.0
#include "toolchain/tools/image/sbom.hpp"

#include "toolchain/tools/image/tool.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace tappet::image {

namespace fs = std::filesystem;

namespace {

/// Archives that this tree builds from foreign source, and the place of their version.
struct BuiltHere {
    std::string_view archive;
    const char* source; ///< a folder of the cache, or a Debian package
    bool in_cache;
};
constexpr BuiltHere built_here[] = {{"libtappet_libmodbus.a", "libmodbus", true},
                                    {"libtappet_pugixml.a", "pugixml", true},
                                    {"libtappet_mathematics.a", "musl-dev", false}};

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Returns the packages of the files. dpkg knows some files by their path before /usr was merged. Calls dpkg
/// once, because each call reads the whole database.
std::set<std::string> packages_of(const std::set<std::string>& files) {
    std::vector<std::string> words{"dpkg-query", "-S"};
    for (const std::string& file : files) {
        words.push_back(file);
        if (file.starts_with("/usr/lib/")) words.push_back(file.substr(4));
    }
    std::istringstream lines{files.empty() ? std::string{} : run_tool(words, Trouble::is_told)};
    std::set<std::string> packages, owned;
    for (std::string line;
         std::getline(lines, line);) { // "libc6-dev:amd64: /usr/lib/..", or that no package has the file
        const std::size_t at = line.rfind(": /");
        if (at == line.npos || line.starts_with("dpkg-query: ")) continue;
        packages.insert(line.substr(0, line.find_first_of(":,")));
        const std::string file = line.substr(at + 2);
        owned.insert(file);
        owned.insert("/usr" + file);
    }
    for (const std::string& file : files)
        if (!owned.contains(file))
            throw Fault("no Debian package holds " + file +
                        ", which was linked; if this tree builds it, name its source in "
                        "toolchain/tools/image/sbom.cpp");
    return packages;
}

} // namespace

Component debian_package(const std::string& name, const std::string& kind) {
    return {name, first_line(run_tool({"dpkg-query", "-W", "-f", "${Version}\n", name})), kind, true};
}

std::vector<Component> linked_into(const fs::path& list, const fs::path& cache) {
    if (!fs::exists(list))
        throw Fault("the linker's list " + list.string() +
                    " is not there; build the firmware by tappet_machine(..)");
    std::istringstream words{read_file(list)};
    std::string word;
    words >> word; // the program itself
    std::set<std::string> files, packages;
    std::vector<Component> components;
    while (words >> word && !word.ends_with(':')) { // rules without a recipe follow
        if (word == "\\") continue;
        const fs::path path = fs::weakly_canonical(list.parent_path() / word);
        const auto ours = std::ranges::find(built_here, path.filename().string(), &BuiltHere::archive);
        if (ours != std::end(built_here) && ours->in_cache)
            components.push_back({ours->source, first_line(read_file(cache / ours->source / "VERSION"))});
        else if (ours != std::end(built_here))
            packages.insert(ours->source);
        else if (word.starts_with('/') && path.extension() == ".a" &&
                 path.parent_path().parent_path() == fs::weakly_canonical(cache))
            components.push_back({path.parent_path().filename().string(),
                                  first_line(read_file(path.parent_path() / "VERSION"))});
        else if (word.starts_with('/') &&
                 path.extension() != ".ld") // a program's own parts have names relative to its build tree
            files.insert(path.string());
    }
    packages.merge(packages_of(files));
    for (const std::string& each : packages) components.push_back(debian_package(each));
    return components;
}

std::string bill_of_materials(const std::string& machine, const std::string& board, std::uint32_t version,
                              std::vector<Component> components) {
    std::ranges::sort(components);
    const auto [first, last] = std::ranges::unique(components);
    components.erase(first, last);
    using Json = nlohmann::ordered_json;
    Json bill{
        {"bomFormat", "CycloneDX"},
        {"specVersion", "1.5"},
        {"version", 1},
        {"metadata",
         {{"component",
           {{"type", "firmware"}, {"name", machine + "-" + board}, {"version", std::to_string(version)}}}}},
        {"components", Json::array()}};
    for (const Component& each : components) {
        Json row{{"type", each.kind}, {"name", each.name}, {"version", each.version}};
        if (each.is_debian) row["purl"] = "pkg:deb/debian/" + each.name + "@" + each.version + "?arch=amd64";
        bill["components"].push_back(std::move(row));
    }
    return bill.dump(2) + "\n";
}

} // namespace tappet::image

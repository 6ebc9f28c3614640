// Reads pages and applies their blocks to a project.
#include "tests/toolchain/guide/page.hpp"

#include "toolchain/tools/front/project.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

namespace tappet::guide {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view hidden = "<!-- ";

std::vector<std::string> lines_of(std::string_view text) {
    std::istringstream stream{std::string{text}};
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
    return std::ranges::find(words, word) != words.end();
}

std::unexpected<std::string> fault(std::size_t line, const std::string& sentence) {
    return std::unexpected(std::to_string(line) + ": " + sentence);
}

std::map<std::string, std::string> begun(const fs::path& templates, const front::Choice& choice) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator{templates}) {
        if (entry.path().extension() != ".in") continue;
        std::ifstream file{entry.path(), std::ios::binary};
        const std::string text{std::istreambuf_iterator<char>{file}, {}};
        files[fs::relative(entry.path(), templates).replace_extension().string()] =
            front::filled(text, choice);
    }
    return files;
}

/// "- a", "  b", "+ c": the lines with - and without a mark stand there, once; those with + take their place.
std::optional<std::string> edited(const std::string& file, const std::string& diff) {
    std::string before, after;
    for (const std::string& line : lines_of(diff)) {
        const std::string rest = line.empty() ? "" : line.substr(1);
        if (line.empty() || line[0] != '+') before += rest + "\n";
        if (line.empty() || line[0] != '-') after += rest + "\n";
    }
    const std::string text = "\n" + file;
    const std::size_t at = text.find("\n" + before);
    if (before.empty() || at == text.npos || text.find("\n" + before, at + 1) != text.npos)
        return std::nullopt;
    return (text.substr(0, at + 1) + after + text.substr(at + 1 + before.size())).substr(1);
}

std::string in_one_line(const std::string& text) {
    std::string sentence;
    for (const std::string& line : lines_of(text)) sentence += (sentence.empty() ? "" : " ") + line;
    return sentence;
}

struct Reader {
    const fs::path& templates;
    Page page{};
    Project first{}, before{}, now{}; ///< at its start, before the last block, after it
    std::string changed{};
    bool may_be_refused = false;

    void take_commands(const Block& block) {
        for (const std::string& line : lines_of(block.text)) {
            page.commands.push_back(line);
            std::istringstream words{line};
            std::string tappet, command;
            words >> tappet >> command;
            if (tappet != "tappet" || command != "new") continue;
            front::Choice choice;
            for (std::string word; words >> word && word != "#";)
                if (word == "--can")
                    choice.can = true;
                else if (word == "--modbus")
                    choice.modbus = true;
                else
                    choice.name = word;
            first = now = {choice.name, begun(templates, choice), ""};
        }
        may_be_refused = false;
    }

    std::expected<void, std::string> change(const Block& block) {
        if (now.name.empty())
            return fault(block.line, "there is no project yet; begin it with tappet new NAME");
        before = now;
        changed = block.argument;
        may_be_refused = true;
        if (block.argument.empty())
            now.code += block.text;
        else if (block.language != "diff")
            now.files[block.argument] = block.text;
        else if (const auto file = edited(now.files[block.argument], block.text))
            now.files[block.argument] = *file;
        else
            return fault(block.line, "the lines before the change are not once in " + block.argument +
                                         "; write them as they stand there");
        return {};
    }

    std::expected<void, std::string> refuse(const Block& block) {
        if (!may_be_refused) return fault(block.line, "no block stands before it that could be refused");
        page.units.push_back({now, in_one_line(block.text), changed, true, block.line});
        if (block.argument == "refused") now = before;
        may_be_refused = false;
        return {};
    }

    std::expected<void, std::string> take(const Block& block) {
        if (block.language == "sh") return take_commands(block), std::expected<void, std::string>{};
        if (block.language == "text" && is_one_of(block.argument, {"refused", "incomplete"}))
            return refuse(block);
        const bool may_have_no_file = block.language == "cpp";
        if (is_one_of(block.language, {"cpp", "osd", "cmake", "diff"}) &&
            (may_have_no_file || !block.argument.empty()))
            return change(block);
        return fault(block.line, "\"" + block.language +
                                     "\" is no block that is tried; write sh, cpp, cpp FILE, osd FILE, cmake "
                                     "FILE, diff FILE, text refused or text incomplete");
    }
};

std::string include(const std::string& name, const std::string& file) {
    return "#include \"" + name + "/" + file + "\"\n";
}

} // namespace

std::expected<std::vector<Block>, std::string> blocks(std::string_view page) {
    std::vector<Block> found;
    std::string_view end; // of the open block
    std::size_t number = 0;
    for (const std::string& line : lines_of(page)) {
        ++number;
        if (!end.empty()) {
            if (line == end)
                end = {};
            else
                found.back().text += line + "\n";
        } else if (line.starts_with("```") || (line.starts_with(hidden) && !line.contains("-->"))) {
            end = line.starts_with("```") ? "```" : "-->";
            std::istringstream words{line.substr(line.starts_with("```") ? 3 : hidden.size())};
            found.push_back({.line = number});
            words >> found.back().language >> found.back().argument;
        }
    }
    if (!end.empty()) return fault(found.back().line, "the block that begins here has no end");
    return found;
}

std::expected<Page, std::string> read_page(std::string_view text, const fs::path& templates) {
    const auto all = blocks(text);
    if (!all) return std::unexpected(all.error());
    Reader reader{templates};
    for (const Block& block : *all)
        if (const auto taken = reader.take(block); !taken) return std::unexpected(taken.error());
    if (reader.now == reader.first) return reader.page;
    reader.first.files["CMakeLists.txt"] = reader.now.files["CMakeLists.txt"];
    reader.page.units.push_back({reader.now, "", "", reader.now != reader.first, 1});
    return reader.page;
}

void write_unit(const Unit& unit, const fs::path& to, const std::string& name, const std::string& page) {
    const Project& project = unit.project;
    for (const auto& [path, text] : project.files) {
        const fs::path place = to / name / path;
        fs::create_directories(place.parent_path());
        std::ofstream{place, std::ios::binary} << text;
    }
    if (!unit.compiles) return;
    // The plant and its test belong to the whole project; a refusal of the table needs neither.
    const bool whole = unit.refusal.empty() || is_one_of(unit.changed, {"plant.hpp", "test.cpp"});
    std::ofstream out{to / (name + ".cpp"), std::ios::binary};
    out << "// " << page << ":" << unit.line << "\n// "
        << (unit.refusal.empty() ? "accepted" : "refused: " + unit.refusal) << "\n"
        << "#include \"tests/toolchain/guide/context.hpp\"\n#define TAPPET_NAMESPACE " << project.name << "\n"
        << "#define TAPPET_PLANT_HEADER \"" << fs::absolute(to / name / "plant.hpp").string() << "\"\n"
        << (whole ? include(name, "test.cpp") : "") << include(name, "machine.hpp")
        << include(name, "bindings.hpp") << include(name, "boards/my_box.hpp") << "namespace " << project.name
        << " {\n"
        << project.code << "} // namespace\n";
    for (const std::string board : {"bench", "my_box"})
        if (!unit.refusal.empty() || board == "my_box") // each project fits all boards, unless a page says
                                                        // otherwise
            out << "template struct tappet::Firmware<" << project.name << "::table, tappet::board::" << board
                << ", " << project.name << "::bindings::" << board << ">;\n";
}

} // namespace tappet::guide

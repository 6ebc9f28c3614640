// The index of refusals: sentence, cause and cure, from the golden sentences of the tests.
#include "toolchain/tools/pages/pages.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace tappet::pages {

namespace fs = std::filesystem;

namespace {

/// Returns where the cure starts, after the cause; a sentence of a map has a colon there.
std::size_t cure_of(std::string_view sentence) {
    const std::size_t semicolon = sentence.rfind("; ");
    return semicolon != sentence.npos ? semicolon : sentence.rfind(": ");
}

std::vector<fs::path> sources_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator{folder})
        if (entry.path().extension() == ".cpp") files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

/// Reads rows {"name", the planted fault, R"(sentence)"}.
void add_rows(const fs::path& file, std::vector<Refusal>& found) {
    static const std::regex part{R"((?:^|\n)\s*\{\"([a-z0-9_]+)\",|R\"(~?)\(([^\n]*)\)\2\"\})"};
    const std::string text = contents_of(file);
    std::string topic = file.stem().string();
    topic.resize(topic.rfind("_test"));
    std::string name;
    for (std::sregex_iterator at(text.begin(), text.end(), part), end; at != end; ++at)
        if ((*at)[1].matched)
            name = (*at)[1].str();
        else
            found.push_back({topic, name, (*at)[3].str()});
}

void add_case(const fs::path& file, std::vector<Refusal>& found) {
    std::ifstream in{file};
    std::string line;
    std::getline(in, line);
    std::getline(in, line);
    constexpr std::string_view refused = "// refused: ";
    const std::string name = file.stem().string();
    if (line.starts_with(refused))
        found.push_back({"seen by a compiler only, or through it", name, line.substr(refused.size())});
}

/// Adds the sentences that a check's tests expect, word by word, with cures: whole, or of a row.
void add_expected(const fs::path& file, const std::string& topic, std::vector<Refusal>& found) {
    static const std::regex test{R"(\nTEST\w*\((\w+), (\w+)\)|,\s*((?:"(?:\\.|[^"\\])*"\s*)+)(?:\);|\},))"};
    static const std::regex literal{R"~("((?:\\.|[^"\\])*)")~"}, escape{R"(\\(.))"};
    const std::string text = contents_of(file);
    std::string name;
    for (std::sregex_iterator at(text.begin(), text.end(), test), end; at != end; ++at) {
        if ((*at)[2].matched) {
            name = (*at)[2].str();
            continue;
        }
        const std::string said = (*at)[3].str();
        std::string sentence;
        for (std::sregex_iterator part(said.begin(), said.end(), literal); part != end; ++part)
            sentence += std::regex_replace((*part)[1].str(), escape, "$1");
        if (cure_of(sentence) != sentence.npos &&
            std::ranges::find(found, sentence, &Refusal::sentence) == found.end())
            found.push_back({topic, name, sentence});
    }
}

} // namespace

std::string contents_of(const fs::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

std::string cell(std::string_view text) {
    std::string escaped;
    bool is_code = false;
    for (const char character : text) {
        is_code ^= character == '`';
        const bool is_mark = character == '<' || character == '*' || character == '_';
        if (character == '|' || (is_mark && !is_code)) escaped += '\\';
        escaped += character;
    }
    return escaped;
}

std::string code(std::string_view text) {
    std::string escaped = "`";
    for (const char character : text) escaped += character == '|' ? "\\|" : std::string{character};
    return escaped + "`";
}

std::vector<Refusal> refusals(const fs::path& tree) {
    std::vector<Refusal> found;
    for (const fs::path& file : sources_in(tree / "tests/diagnostics/rows")) add_rows(file, found);
    for (const fs::path& file : sources_in(tree / "tests/diagnostics/cases")) add_case(file, found);
    add_expected(tree / "tests/kernel/statechart/check_test.cpp", "state machines", found);
    add_expected(tree / "tests/kernel/limits/limits_test.cpp", "limits", found);
    add_expected(tree / "tests/drivers/can/signal_map_test.cpp", "CAN signal maps", found);
    add_expected(tree / "tests/drivers/can/dbc_faults_test.cpp", "DBC files", found);
    add_expected(tree / "tests/drivers/modbus/register_map_test.cpp", "Modbus register maps", found);
    return found;
}

std::expected<std::string, std::string> refusals_page(const fs::path& tree) {
    const std::vector<Refusal> all = refusals(tree);
    if (all.empty()) return std::unexpected("no refusal was found below " + tree.string());
    std::ostringstream page;
    page << "# Every refusal\n\nThe compiler's messages for machines that cannot work; " << all.size()
         << " tests check them to the character. A message begins with the machine's name and the row; `#` "
            "stands for a number.\n";
    std::string topic;
    for (const Refusal& each : all) {
        if (each.topic != topic) {
            topic = each.topic;
            page << "\n## " << topic << "\n\n| cause | cure |\n|---|---|\n";
        }
        const std::size_t cure = cure_of(each.sentence);
        if (cure == std::string::npos)
            return std::unexpected(each.name + ": the message states no cure: " + each.sentence);
        page << "| " << code(std::string_view{each.sentence}.substr(0, cure)) << " | "
             << code(std::string_view{each.sentence}.substr(cure + 2)) << " |\n";
    }
    return page.str();
}

} // namespace tappet::pages

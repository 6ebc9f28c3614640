// Finds the files, checks each by the reader of its kind, and writes the table.
#include "toolchain/tools/check/check.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace tappet::checking {

namespace {

namespace fs = std::filesystem;

struct Reader {
    std::string_view extension;
    std::vector<Finding> (*check)(std::string_view text);
    bool names_nodes; ///< the findings say which nodes they affect
};
constexpr Reader readers[] = {
    {".dbc", &check_dbc, true}, {".eds", &check_eds, false}, {".dcf", &check_eds, false}};
constexpr std::string_view kinds = ".dbc, .eds or .dcf";

const Reader* reader_of(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& each : extension)
        each = each >= 'A' && each <= 'Z' ? static_cast<char>(each - 'A' + 'a') : each;
    const auto* const found = std::ranges::find(readers, extension, &Reader::extension);
    return found == std::end(readers) ? nullptr : found;
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& each : names) text += (text.empty() ? "" : ", ") + each;
    return text;
}
std::string count_of(std::size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

constexpr std::string_view word_of(Weight weight) {
    return weight == Weight::note ? "note" : weight == Weight::fault ? "fault" : "unreadable";
}

bool concerns(const Finding& finding, const std::string& node) {
    return std::ranges::find(finding.affects, node) != finding.affects.end();
}

std::string verdict_on(const std::vector<Finding>& findings) {
    const auto count = [&](Weight weight) {
        return static_cast<std::size_t>(std::ranges::count(findings, weight, &Finding::weight));
    };
    if (count(Weight::unreadable) != 0) return "unreadable";
    const std::string notes = count(Weight::note) == 0 ? "" : ", " + count_of(count(Weight::note), "note");
    if (count(Weight::fault) == 0) return "good" + notes;
    return count_of(count(Weight::fault), "fault") + notes + "; a row that takes such a part is refused";
}

/// The columns are as wide as their widest cell.
std::string table_of(const std::string& file, const std::vector<Finding>& findings) {
    std::vector<std::vector<std::string>> rows;
    for (const Finding& each : findings) {
        std::string meaning = each.meaning;
        for (char& sign : meaning) // a file may hold what a terminal obeys
            if (static_cast<unsigned char>(sign) < 0x20 || sign == 0x7F) sign = '?';
        if (each.more != 0) meaning += " (and in " + count_of(each.more, "more line") + ")";
        rows.push_back({file + ":" + std::to_string(each.line), std::string{word_of(each.weight)},
                        each.weight == Weight::unreadable ? "all"
                        : each.affects.empty()            ? "nobody"
                                                          : joined(each.affects),
                        std::move(meaning)});
    }
    std::size_t widths[3] = {};
    for (const auto& row : rows)
        for (std::size_t c = 0; c < 3; ++c) widths[c] = std::max(widths[c], row[c].size());
    std::string text;
    for (const auto& row : rows) {
        for (std::size_t c = 0; c < 3; ++c) text += row[c] + std::string(widths[c] - row[c].size() + 2, ' ');
        text += row[3] + "\n";
    }
    return text;
}

/// Adds the files that a path names; returns why not.
std::string add_files(const std::string& path, std::vector<fs::path>& files) {
    std::error_code failed;
    if (!fs::is_directory(path, failed)) {
        if (!fs::exists(path, failed)) return "there is no file \"" + path + "\"";
        if (reader_of(path) == nullptr)
            return "\"" + path + "\" is no file that it reads; name files that end in " + std::string{kinds} +
                   ", or a folder";
        files.emplace_back(path);
        return {};
    }
    const std::size_t before = files.size();
    for (auto each =
             fs::recursive_directory_iterator{path, fs::directory_options::skip_permission_denied, failed};
         !failed && each != fs::recursive_directory_iterator{}; each.increment(failed))
        if (each->is_regular_file(failed) && reader_of(each->path()) != nullptr)
            files.push_back(each->path());
    std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
    return files.size() == before ? "folder \"" + path + "\" has no file that ends in " + std::string{kinds}
                                  : "";
}

} // namespace

Report report_on(const std::vector<std::string>& paths, const std::string& node) {
    Report report;
    std::vector<fs::path> files;
    if (paths.empty()) report.failure = "name files or folders: tappet check press.dbc";
    for (const std::string& path : paths)
        if (report.failure.empty()) report.failure = add_files(path, files);
    if (!report.failure.empty()) return report;
    for (const fs::path& path : files) {
        std::ifstream file{path, std::ios::binary};
        const std::string text{std::istreambuf_iterator<char>{file}, {}};
        if (!file) return {.text = {}, .failure = "\"" + path.string() + "\" cannot be read"};
        const Reader& reader = *reader_of(path);
        std::vector<Finding> findings = reader.check(text);
        for (Finding& each : findings)
            if (each.weight == Weight::fault && reader.names_nodes && !node.empty() && !concerns(each, node))
                each.weight = Weight::note;
        report.text += table_of(path.string(), findings) + path.string() + ": " + verdict_on(findings) + "\n";
        report.has_faults |=
            std::ranges::any_of(findings, [](const Finding& each) { return each.weight != Weight::note; });
    }
    return report;
}

} // namespace tappet::checking

// Options as a table: a word, and the destination of its value.
#include "tests/figures/report/options.hpp"

#include <charconv>

namespace tappet::figures {

namespace {

bool read(const std::string& text, double& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() && value >= 0;
}

} // namespace

std::expected<ReportOptions, std::string> read_report_options(const std::vector<std::string>& words) {
    ReportOptions options;
    double rounds = static_cast<double>(options.rounds);
    const struct {
        const char* word;
        std::string* text;
        double* number;
    } valued[] = {
        {"--programs", &options.programs, nullptr},     {"--output", &options.output, nullptr},
        {"--against", &options.against, nullptr},       {"--against-name", &options.against_name, nullptr},
        {"--limit", nullptr, &options.limit},           {"--rounds", nullptr, &rounds},
        {"--margin", nullptr, &options.margin_percent}, {"--only", nullptr, nullptr},
    };
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (word == "--long" || word == "--brief" || word == "--smoke") {
            options.setting = word.substr(2);
            continue;
        }
        if (word == "--no-counts") {
            options.counts = false;
            continue;
        }
        bool known = false;
        for (const auto& option : valued) {
            if (word != option.word) continue;
            known = true;
            if (i + 1 == words.size()) return std::unexpected("'" + word + "' lacks its value");
            const std::string& value = words[++i];
            if (option.text != nullptr)
                *option.text = value;
            else if (option.number == nullptr)
                options.only.push_back(value);
            else if (!read(value, *option.number))
                return std::unexpected("'" + word + "' takes a number, not '" + value + "'");
        }
        if (!known) return std::unexpected("'" + word + "' is no option; ci/figures --help lists them");
    }
    constexpr double fewest = 3, most = 1000; // rounds: fewer say nothing about the spread
    if (rounds < fewest || rounds > most || rounds != static_cast<double>(static_cast<std::size_t>(rounds)))
        return std::unexpected("--rounds takes a whole number from 3 to 1000");
    options.rounds = static_cast<std::size_t>(rounds);
    if (options.output.empty()) return std::unexpected("--output DIR is missing: where the report goes");
    if (options.programs.empty())
        return std::unexpected("--programs DIR is missing: the build's folder of figures");
    return options;
}

} // namespace tappet::figures

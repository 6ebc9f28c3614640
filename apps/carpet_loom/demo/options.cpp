// Reading the command line.
#include "apps/carpet_loom/demo/options.hpp"

#include <charconv>
#include <string_view>

namespace tappet::demo {

namespace {

template <class Number> bool take(Number& to, std::string_view text, Number least, Number most) {
    Number value{};
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data(), end, value);
    if (text.empty() || error != std::errc{} || at != end || value < least || value > most) return false;
    to = value;
    return true;
}

std::string* text_option(Options& options, std::string_view word) {
    if (word == "--firmware") return &options.firmware;
    if (word == "--plant") return &options.plant;
    if (word == "--browser") return &options.browser;
    if (word == "--behaviours") return &options.behaviours;
    if (word == "--init") return &options.init;
    if (word == "--summary") return &options.summary;
    return nullptr;
}

constexpr std::int64_t most_picks = 100'000;

} // namespace

std::expected<Options, std::string> parse_options(int count, const char* const* words) {
    const auto error = [](const std::string& text) { return std::unexpected(text); };
    Options options;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        if (word == "--help") {
            options.help = true;
            return options;
        }
        if (word == "--plain") {
            options.plain = true;
            continue;
        }
        std::string* const to = text_option(options, word);
        if (to == nullptr && word != "--picks" && word != "--seed")
            return error("'" + word + "' is no option; --help lists them");
        if (i + 1 == count) return error("'" + word + "' wants a value; --help shows which");
        const std::string_view value = words[++i];
        if (to != nullptr) *to = value;
        if (word == "--picks" && !take<std::int64_t>(options.picks, value, 1, most_picks))
            return error("--picks takes a number from 1 to 100000, not '" + std::string{value} + "'");
        if (word == "--seed" && !take<std::uint64_t>(options.seed, value, 0, UINT64_MAX))
            return error("--seed takes a whole number from 0, not '" + std::string{value} + "'");
    }
    for (const auto& [name, path] : {std::pair{"--firmware", &options.firmware},
                                     {"--plant", &options.plant},
                                     {"--browser", &options.browser},
                                     {"--behaviours", &options.behaviours},
                                     {"--init", &options.init},
                                     {"--summary", &options.summary}})
        if (path->empty()) return error(std::string{name} + " is missing; ci/demo gives it");
    return options;
}

const char* usage() {
    return "carpet-loom-demo --firmware FILE --plant FILE --browser FILE --behaviours FOLDER --init FILE "
           "--summary FILE [--picks N] [--seed N] [--plain]\n"
           "ci/demo builds the programs and names them; ci/demo --help explains the rest\n";
}

} // namespace tappet::demo

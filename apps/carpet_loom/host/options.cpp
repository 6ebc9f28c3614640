// Reads the command line: every option once, every number whole, a refusal with its cure.
#include "apps/carpet_loom/host/options.hpp"

#include "kernel/base/nearest.hpp"

#include <charconv>

namespace tappet::carpet {

namespace {

std::expected<std::uint64_t, Sentence> number(std::string_view option, std::string_view word) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size())
        return std::unexpected(Sentence{"option ", option, ": \"", word,
                                        "\" is not a whole number; write for example ", option, " 200"});
    return value;
}

} // namespace

std::expected<Options, Sentence> parse_options(int count, const char* const* words) {
    Options options;
    options.plant.weft_break_one_in = 40;
    options.plant.warp_break_one_in = 150;
    constexpr std::string_view known[] = {"--world",   "--virtual",     "--real",        "--seed",
                                          "--picks",   "--weft-breaks", "--warp-breaks", "--emergency-stops",
                                          "--summary", "--properties",  "--browse",      "--quiet",
                                          "--plan",    "--help"};
    for (int i = 1; i < count; ++i) {
        const std::string_view option = words[i];
        if (option == "--virtual" || option == "--real") {
            options.virtual_time = option == "--virtual";
            continue;
        }
        if (bool* flag = option == "--quiet"  ? &options.quiet
                         : option == "--plan" ? &options.plan
                         : option == "--help" ? &options.help
                                              : nullptr) {
            *flag = true;
            continue;
        }
        bool takes_value = false;
        for (const auto& each : known) takes_value |= each == option;
        if (!takes_value) {
            Nearest nearest{option};
            for (const auto& each : known) nearest.consider(each);
            Sentence error{"option ", option, " is unknown"};
            if (nearest.best().empty())
                error.add("; see --help");
            else
                error.add("; did you mean ").add(nearest.best()).add("?");
            return std::unexpected(error);
        }
        if (i + 1 == count)
            return std::unexpected(Sentence{"option ", option, " needs a value after it; see --help"});
        const std::string_view word = words[++i];
        if (option == "--summary" || option == "--properties") {
            (option == "--summary" ? options.summary : options.properties) = word;
            continue;
        }
        if (option == "--browse") {
            options.browse = word;
            continue;
        }
        if (option == "--world") {
            if (word != "host")
                return std::unexpected(
                    Sentence{"option --world: this program is built for the board \"host\" and runs there "
                             "only; the bench's is started by ci/demo"});
            continue;
        }
        const auto value = number(option, word);
        if (!value) return std::unexpected(value.error());
        if (option == "--seed") options.seed = *value;
        if (option == "--picks") options.picks = *value;
        if (option == "--weft-breaks") options.plant.weft_break_one_in = *value;
        if (option == "--warp-breaks") options.plant.warp_break_one_in = *value;
        if (option == "--emergency-stops") options.plant.emergency_stop_one_in = *value;
    }
    if (options.picks == 0)
        return std::unexpected(Sentence{"option --picks: 0 picks are woven at once; ask for at least 1"});
    options.plant.last_pick = options.picks;
    return options;
}

} // namespace tappet::carpet

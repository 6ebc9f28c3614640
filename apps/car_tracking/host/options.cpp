// Reads the command line: a refusal names its cure.
#include "apps/car_tracking/host/options.hpp"

#include "kernel/base/nearest.hpp"

#include <charconv>

namespace tappet::car_tracking {

std::expected<Options, Sentence> parse_options(int count, const char* const* words) {
    Options options;
    constexpr std::string_view known[] = {"--virtual", "--seed", "--seconds", "--picture", "--help"};
    for (int i = 1; i < count; ++i) {
        const std::string_view option = words[i];
        if (option == "--virtual") continue;
        if (option == "--help") {
            options.help = true;
            continue;
        }
        Nearest nearest{option};
        bool is_known = false;
        for (const auto& each : known) is_known |= each == option, nearest.consider(each);
        if (!is_known) {
            Sentence error{"option ", option, " is unknown"};
            error.add(nearest.best().empty() ? "; see --help" : "; did you mean ").add(nearest.best());
            return std::unexpected(error);
        }
        if (i + 1 == count)
            return std::unexpected(Sentence{"option ", option, " needs a value after it; see --help"});
        const std::string_view word = words[++i];
        if (option == "--picture") {
            options.picture = word;
            continue;
        }
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc{} || end != word.data() + word.size())
            return std::unexpected(Sentence{"option ", option, ": \"", word,
                                            "\" is not a whole number; write for example ", option, " 60"});
        (option == "--seed" ? options.seed : options.seconds) = value;
    }
    constexpr std::uint64_t most_seconds = 3600;
    if (options.seconds == 0 || options.seconds > most_seconds)
        return std::unexpected(Sentence{"option --seconds: a run takes from 1 to 3600 s"});
    return options;
}

} // namespace tappet::car_tracking

// Reading the command line.
#include "apps/carpet_loom/demo/options.hpp"

#include "toolchain/command_line.hpp"

#include <array>
#include <vector>

namespace tappet::demo {

namespace {

// The first ones name what is built: ci/demo gives them.
constexpr std::size_t built = 6;
constexpr std::array table{
    Option{"--firmware", "FILE", "stripped, as it is flashed"},
    Option{"--plant", "FILE", "the plant's program for the bench"},
    Option{"--browser", "FILE", "tappet-browse"},
    Option{"--behaviours", "DIR", "of the scripts that are loaded on the way"},
    Option{"--init", "FILE", "PID 1 of the bench"},
    Option{"--summary", "FILE", "where the JSON goes"},
    Option{.name = "--picks",
           .value = "N",
           .help = "ends when they are woven",
           .is_number = true,
           .least = 1,
           .most = 100'000},
    Option{.name = "--seed", .value = "N", .help = "which loom, and which breaks", .is_number = true},
    Option{"--plain", "", "one line per second, without colours"},
    Option{"--help", "", "this text"}};

} // namespace

std::expected<Options, std::string> parse_options(int count, const char* const* words) {
    const std::vector<std::string_view> all(words + 1, words + count);
    const auto line = read_command_line(table, all, Others::refused);
    if (!line) return std::unexpected(line.error());
    Options options;
    options.help = line->has("--help");
    options.plain = line->has("--plain");
    options.picks =
        static_cast<std::int64_t>(line->number("--picks", static_cast<std::uint64_t>(options.picks)));
    options.seed = line->number("--seed", options.seed);
    std::string* const files[built] = {&options.firmware,   &options.plant, &options.browser,
                                       &options.behaviours, &options.init,  &options.summary};
    for (std::size_t i = 0; i < built && !options.help; ++i) {
        *files[i] = line->text(table[i].name);
        if (files[i]->empty())
            return std::unexpected(std::string{table[i].name} + " is missing; ci/demo gives it");
    }
    return options;
}

std::string usage() {
    return "carpet-loom-demo, whose programs ci/demo builds and names\n" + usage_of(table);
}

} // namespace tappet::demo

// The table of command line options, and the steps of the bench.
#include "apps/carpet_loom/demo/scenario.hpp"

#include "apps/carpet_loom/demo/verdict.hpp"

#include <algorithm>
#include <array>

namespace tappet::demo {

namespace {

// The first options name built files; ci/demo sets them.
constexpr std::size_t built = 6;
constexpr std::array table{
    Option{"--firmware", "FILE", "stripped, as it is flashed"},
    Option{"--plant", "FILE", "the plant's program for the bench"},
    Option{"--browser", "FILE", "tappet-browse"},
    Option{"--behaviours", "DIR", "the scripts that are loaded during the run"},
    Option{"--init", "FILE", "PID 1 of the bench"},
    Option{"--summary", "FILE", "where the JSON goes"},
    Option{.name = "--picks",
           .value = "N",
           .help = "ends when N picks are woven",
           .is_number = true,
           .least = 1,
           .most = 100'000},
    Option{.name = "--seed", .value = "N", .help = "which loom, and which breaks", .is_number = true},
    Option{"--plain", "", "one line per second, without colours"},
    Option{"--help", "", "this text"}};

std::string load(const std::string& script, const std::string& moment) {
    return "tappet-browse behaviour load /weaves/" + script + " weft --at " + moment;
}

} // namespace

std::expected<CommandLine, std::string> read_options(std::span<const std::string_view> words) {
    auto line = read_command_line(table, words, Others::refused);
    if (!line || line->has("--help")) return line;
    for (std::size_t i = 0; i < built; ++i)
        if (line->text(table[i].name).empty())
            return std::unexpected(std::string{table[i].name} + " is missing; ci/demo gives it");
    return line;
}

std::string usage() {
    return "carpet-loom-demo, whose programs ci/demo builds and names\n" + usage_of(table);
}

std::vector<std::string> troubles(std::uint64_t picks) {
    const auto at = [picks](std::uint64_t quarter) {
        return std::to_string(std::max<std::uint64_t>(picks * quarter / 4, 1));
    };
    return {"--weft-break-one-in", "40",   "--warp-break-one-in", "150", "--weft-break-at",     at(1),
            "--emergency-stop-at", at(2),  "--warp-break-at",     at(3), "--operator-reaction", "500ms",
            "--stop-servers-at",   "3s/2s"};
}

bench::Scenario scenario_of(const CommandLine& options) {
    const auto file = [&options](const char* name) { return std::string{options.text(name)}; };
    const std::uint64_t picks = options.number("--picks", usual_picks);
    const bool changes_weaves = picks >= least_picks_for_weaves;
    std::string plant = "carpet-loom-plant --seed " + std::to_string(options.number("--seed", usual_seed)) +
                        " --picks " + std::to_string(picks);
    for (const std::string& word : troubles(picks)) plant += " " + word;
    // The duration of a browser's requests depends on the host: the plant weaves until they are done, and
    // some more picks.
    if (changes_weaves) plant += " --picks-after-usr1 20";
    bench::Scenario scenario;
    bench::add_board(scenario);
    scenario.init = file("--init");
    scenario.files = {{file("--firmware"), "/bin/carpet_loom"},
                      {file("--plant"), "/bin/carpet-loom-plant"},
                      {file("--browser"), "/bin/tappet-browse"},
                      {file("--behaviours"), "/weaves"}};
    std::vector<std::string>& steps = scenario.commands;
    steps = {plant + " --report " + plant_report + " &", "@sleep 1",
             std::string{"carpet_loom --summary "} + machine_report + " &"};
    // A new weave takes over at a shaft angle. A faulty one is refused with its line; one that misbehaves is
    // rolled back. The loom keeps weaving through all of this.
    if (changes_weaves)
        for (const std::string& step :
             {std::string{"@sleep 6"}, load(new_weave, "180"), std::string{"@sleep 2"},
              "- " + load("faulty_twill.osd", "180"), load("running_out.osd", "shaft.beat_up"),
              std::string{"@sleep 3"}, std::string{"tappet-browse behaviour list"},
              std::string{"@signal carpet-loom-plant USR1"}})
            steps.push_back(step);
    for (const char* step :
         {"@wait carpet-loom-plant while carpet_loom", "@signal carpet_loom TERM", "@wait carpet_loom"})
        steps.emplace_back(step);
    scenario.timeout_s = 180.0 + 6.0 * static_cast<double>(picks); // for a host ten times slower than ours
    return scenario;
}

} // namespace tappet::demo

// The carpet loom on the host: machine and plant in one process.
#include "apps/carpet_loom/host/options.hpp"
#include "apps/carpet_loom/host/virtual_run.hpp"
#include "apps/carpet_loom/summary.hpp"
#include "kernel/os/box.hpp"
#include "kernel/os/terminal.hpp"
#include "kernel/services/json.hpp"

#include <array>
#include <string>

namespace {

using namespace tappet;

int fail(const Sentence& why) {
    static_cast<void>(os::write_all(2, Sentence{"carpet_loom: ", why, "\n"}.view()));
    return 2;
}

int report(carpet::VirtualRun& run, const carpet::Options& options, bool woven) {
    static std::array<char, 256 * 1024> text;
    carpet::RunFacts facts;
    facts.world = "host";
    facts.realtime = false;
    facts.seed = options.seed;
    facts.can_frames_lost = run.loom().machine_can().counters().lost_in_kernel;
    facts.gpio_edges_lost = run.loom().lines().counters().missed;
    const Sentence stop = run.instance().stop_asked() ? run.instance().describe_stop() : Sentence{woven ? "the picks are woven" : "the picks were not woven in time"};
    facts.stop_reason = stop.view();
    facts.with_digest = true;
    const std::size_t machine = carpet::write_machine_summary(run.instance(), facts, text);
    const std::size_t plant = machine == 0 ? 0 : loom::write_json(run.loom().plant().report(), std::span{text}.subspan(machine));
    if (plant == 0) return fail(Sentence{"the summary does not fit its buffer"});
    // The plant's object becomes the machine's fields: its opening brace turns into a comma.
    text[machine] = ',';
    std::size_t length = machine + plant;
    while (length > 0 && text[length - 1] != '}') --length;
    JsonText ending{std::span{text}.subspan(length - 1)};
    ending.raw(", \"event_log_digest\": \"").raw(Sentence{static_cast<std::int64_t>(run.event_log_digest() >> 1)}.view()).raw("\"}\n");
    const std::string_view whole{text.data(), length - 1 + ending.size()};
    if (!options.summary.empty()) {
        const std::string path{options.summary};
        if (!os::replace_file(path.c_str(), whole)) return fail(Sentence{"the summary cannot be written to \"", options.summary, "\"; name a file in a folder that exists"});
    }
    return woven ? 0 : 1;
}

} // namespace

int main(int count, char** words) {
    const auto options = carpet::parse_options(count, words);
    if (!options) return fail(options.error());
    if (options->help) {
        os::print(carpet::usage);
        return 0;
    }
    if (!options->virtual_time) return fail(Sentence{"real time"});
    static carpet::VirtualRun run{options->plant, options->seed, options->quiet};
    if (const auto started = run.start(); !started) return fail(started.error());
    const bool woven = run.weave(options->picks, 30s + options->picks * 2s);
    run.stop();
    return report(run, *options, woven);
}

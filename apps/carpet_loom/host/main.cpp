// The carpet loom on the host: machine and plant in one process.
#include "apps/carpet_loom/host/loom_on_host.hpp"
#include "apps/carpet_loom/host/options.hpp"
#include "apps/carpet_loom/host/real_run.hpp"
#include "apps/carpet_loom/host/virtual_run.hpp"
#include "apps/carpet_loom/summary.hpp"
#include "kernel/machine/plan_text.hpp"
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

struct Outcome {
    bool woven = false;
    std::uint64_t page_faults = 0;
    Sentence broken_contract{};
    std::uint64_t contracts_broken = 0;
    std::uint64_t event_log_digest = 0; ///< virtual time only
};

std::array<char, 256 * 1024> text;

/// The machine's object, and the plant's as more fields of it. 0 when the buffer is too small.
std::size_t write_summary(MachineInstance& instance, carpet::InProcessLoom& loom,
                          const carpet::Options& options, const Outcome& outcome) {
    const auto& bus = *instance.find<can::Bus<carpet::can_signals>>("can");
    const can::Counters seen = bus.counters();
    carpet::RunFacts facts;
    facts.world = "host";
    facts.realtime = !options.virtual_time && os::kernel_is_realtime();
    facts.seed = options.seed;
    facts.page_faults_after_arming = outcome.page_faults;
    facts.can_frames_lost = seen.lost_in_kernel;
    facts.gpio_edges_lost = loom.lines().counters().missed;
    facts.modbus_outages_survived =
        instance.find<modbus::Client<carpet::utility_registers>>("utility")->counters().outages_survived;
    facts.wires = {seen.faults, seen.restarts, bus.decoding().wrong_lengths, seen.impostors, seen.malformed};
    Sentence reason{outcome.woven ? "the picks are woven" : "the picks were not woven in time"};
    if (!outcome.broken_contract.empty())
        reason = outcome.broken_contract;
    else if (instance.stop_asked())
        reason = instance.describe_stop();
    facts.stop_reason = reason.view();
    facts.contracts_broken = outcome.contracts_broken;
    facts.with_digest = options.virtual_time;
    const std::size_t machine = carpet::write_machine_summary(instance, facts, text);
    const std::size_t plant =
        machine == 0 ? 0 : loom::write_json(loom.plant().report(), std::span{text}.subspan(machine));
    if (plant == 0) return 0;
    text[machine] = ','; // the plant's opening brace
    std::size_t length = machine + plant;
    while (length > 0 && text[length - 1] != '}') --length;
    JsonText ending{std::span{text}.subspan(length - 1)};
    if (options.virtual_time) {
        char digits[16] = {};
        for (std::size_t i = 0; i < 16; ++i)
            digits[i] = "0123456789abcdef"[outcome.event_log_digest >> (60 - 4 * i) & 0xF];
        ending.raw(", \"event_log_digest\": \"").raw({digits, 16}).raw("\"");
    }
    ending.raw("}\n");
    return ending.size() == 0 ? 0 : length - 1 + ending.size();
}

int report(MachineInstance& instance, carpet::InProcessLoom& loom, const carpet::Options& options,
           const Outcome& outcome) {
    if (!outcome.broken_contract.empty())
        os::print(Sentence{"carpet_loom: ", outcome.broken_contract, "\n"}.view());
    for (std::size_t a = 0; a < instance.engines().size(); ++a)
        for (const Sentence& told :
             {instance.observation().describe_budget(a), instance.observation().describe_end(a)})
            if (!told.empty()) os::print(Sentence{"carpet_loom: ", told, "\n"}.view());
    if (!options.properties.empty())
        if (const Sentence fault = instance.save_properties(instance.standing()); !fault.empty())
            return fail(fault);
    if (!options.summary.empty()) {
        const std::size_t length = write_summary(instance, loom, options, outcome);
        if (length == 0) return fail(Sentence{"the summary does not fit its buffer"});
        const std::string path{options.summary};
        if (!os::replace_file(path.c_str(), {text.data(), length}))
            return fail(Sentence{"the summary cannot be written to \"", options.summary,
                                 "\"; name a file in a folder that exists"});
    }
    return outcome.woven ? 0 : 1;
}

Duration time_for(std::uint64_t picks) { return 30s + picks * 2s; }

int run_virtual(const carpet::Options& options) {
    static carpet::VirtualRun run{options.plant, options.seed, options.quiet};
    run.instance().browse_in(options.browse);
    if (const auto started = run.start(); !started) return fail(started.error());
    Outcome outcome;
    outcome.woven = run.weave(options.picks, time_for(options.picks));
    run.stop();
    outcome.event_log_digest = run.event_log_digest();
    return report(run.instance(), run.loom(), options, outcome);
}

int run_real(const carpet::Options& options) {
    static carpet::RealRun run{options.plant, options.seed, options.quiet};
    run.instance().browse_in(options.browse);
    if (const auto started = run.start(2); !started) return fail(started.error());
    Outcome outcome;
    outcome.woven = run.weave(options.picks, time_for(options.picks));
    const int hung = run.stop();
    outcome.page_faults = run.world().page_faults_in_real_time_threads();
    outcome.broken_contract = run.world().broken_contract();
    outcome.contracts_broken = run.world().breaches();
    outcome.woven &= hung == 0;
    return report(run.instance(), run.loom(), options, outcome);
}

} // namespace

int main(int count, char** words) {
    const auto options = carpet::parse_options(count, words);
    if (!options) return fail(options.error());
    if (options->help) {
        os::print(carpet::usage);
        return 0;
    }
    if (options->plan) {
        describe_plan(carpet::loom_on_host(), nullptr,
                      [](void*, std::string_view line) { os::print(Sentence{line, "\n"}.view()); });
        return 0;
    }
    if (!options->properties.empty()) carpet::keep_properties_in(options->properties);
    return options->virtual_time ? run_virtual(*options) : run_real(*options);
}

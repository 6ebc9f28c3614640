// The program of a machine's swarm: runs seed after seed, and reports their results.
#include "kernel/base/contract.hpp"
#include "kernel/os/clock.hpp"
#include "kernel/os/terminal.hpp"
#include "toolchain/machine/swarm.hpp"
#include "toolchain/machine/swarm_options.hpp"
#include "toolchain/version.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <csignal>
#include <fcntl.h>
#include <unistd.h>

namespace tappet {

namespace {

constexpr std::array options{
    Option{.name = "--hours",
           .value = "N",
           .help = "N hours of the machine's time (default 1)",
           .is_number = true,
           .least = 1,
           .most = 1'000'000},
    Option{.name = "--minutes",
           .value = "N",
           .help = "N minutes of the machine's time instead",
           .is_number = true,
           .least = 1},
    Option{.name = "--working",
           .value = "N",
           .help = "N seconds of processor time instead",
           .is_number = true,
           .least = 1},
    swarm_options::findings,
    swarm_options::from,
    swarm_options::step,
    Option{
        .name = "--bit-rate",
        .value = "N",
        .help =
            "cycles take random times up to their budgets, frames their times at N bit/s (default: no time)",
        .is_number = true,
        .least = 1,
        .most = 1'000'000},
    Option{.name = "--data-bit-rate",
           .value = "N",
           .help = "bit rate of CAN FD's data phase (default: --bit-rate)",
           .is_number = true,
           .least = 1,
           .most = 10'000'000},
    Option{"--anyone", "",
           "people may do anything; checks only the rules of every machine (default for a machine without a "
           "SWARM)"},
    Option{"--calm", "", "nothing fails: measures the responses of a working machine"},
    Option{.name = "--seed",
           .value = "SEED",
           .help = "runs only SEED, and prints what happens",
           .is_number = true},
    swarm_options::help};
enum Ending : int { none_broken = 0, one_broken = 1, wrong_words = 2 };

constexpr unsigned longest_seed = 300; // s of real time

Sentence replay; // command for the running seed
int standard_output = 1;

// Discards the machine's own output: it would hide the swarm's lines.
void silence_machine() {
    standard_output = ::dup(1);
    if (const int nothing = ::open("/dev/null", O_WRONLY); nothing >= 0) {
        ::dup2(nothing, 1);
        ::close(nothing);
    }
}
void print(std::string_view text) { static_cast<void>(os::write_all(standard_output, text)); }

Sentence in_s(Duration time) { return Sentence{time / 1s, ".", (time / 100ms) % 10, " s"}; }

void tell_contract(const ContractViolation& breach) noexcept TAPPET_REALTIME {
    TAPPET_ESCAPE("the swarm is over", print(Sentence{describe(breach), "\n", replay}.view());
                  ::_exit(one_broken));
}

// A machine that crashes or does not end is a finding, too.
void die_telling() {
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM}) {
        struct sigaction action{};
        action.sa_handler = [](int which) {
            print(which == SIGALRM ? "the machine hangs; " : "the machine crashed; ");
            print(replay.view());
            ::_exit(one_broken);
        };
        ::sigaction(signal, &action, nullptr);
    }
}

struct Totals {
    Duration time{};
    std::uint64_t seeds = 0, broken = 0, restarts = 0;
    std::vector<Duration> back{};
    std::vector<Duration> usual{}, responses{}; // of seeds without too frequent wakes, and of the others
    std::map<std::string, std::uint64_t> faults{};
    std::map<std::string, std::vector<std::uint64_t>> waited_for{}; // with their seeds

    void add(std::uint64_t seed, const SwarmVerdict& verdict) {
        ++seeds;
        time += verdict.time;
        restarts += verdict.restarts;
        broken += verdict.broken.empty() ? 0u : 1u;
        auto& longest = verdict.woken_too_often ? responses : usual;
        for (std::size_t a = 0; a < verdict.responses.size(); ++a)
            longest[a] = std::max(longest[a], verdict.responses[a]);
        for (const auto& [kind, number] : verdict.faults) faults[kind] += number;
        if (!verdict.waited_for.empty())
            waited_for[verdict.waited_for].push_back(seed);
        else if (verdict.broken.empty())
            back.push_back(verdict.back);
    }
    void print_responses(const AcceptedMachine& machine) const {
        const std::vector<Duration> analysed = analysed_responses(machine);
        for (std::size_t a = 0; a < analysed.size(); ++a) {
            if (analysed[a] == Duration{}) continue;
            print(Sentence{"activity ", machine.table.activities[a].name, ": longest response ",
                           usual[a] / 1us, " us of ", analysed[a] / 1us, " us analysed, ",
                           100 * usual[a] / analysed[a], " %; ", responses[a] / 1us,
                           " us where some were woken more often than their rows say\n"}
                      .view());
        }
    }
    void print_all(std::string_view name, Duration took) {
        print(Sentence{name, ": ", seeds, " seeds, ", time / 1s, " s of the machine in ", in_s(took), ", ",
                       time / std::max(took, Duration{1ms}), " times as fast; ", broken, " broken\n"}
                  .view());
        print("struck:");
        for (const auto& [kind, number] : faults) print(Sentence{" ", kind, " ", number, ","}.view());
        print(Sentence{" and ", restarts, " stops\n"}.view());
        if (!back.empty()) {
            std::ranges::sort(back);
            print(Sentence{"worked again ", in_s(back[back.size() / 2]),
                           " after the last fault in half of them, ", in_s(back.back()), " at most\n"}
                      .view());
        }
        for (const auto& [what, by] : waited_for)
            print(Sentence{"worked again only after a restart, ", by.size(), " times, for example with seed ",
                           by.front(), ": waited for ", what, "\n"}
                      .view());
    }
};

void print_timed(Time now, std::string_view text) {
    print(Sentence{to_ns(now) / 1000, " us: ", text, "\n"}.view());
}

/// Prints the devices that the swarm neither disturbs nor judges.
void tell_unjudged(const MachineView& table) {
    for (const ComponentRow& row : table.components)
        if (const DeviceKind* const kind = row.type->device_kind;
            kind != nullptr && !row.type->shares_device && !SimulatedDevices::is_judged(row))
            print(Sentence{table.name, ": the ", kind->name, " device \"", row.device, "\" of component \"",
                           row.name,
                           "\" is neither disturbed nor judged: its twin has no outputs for a swarm\n"}
                      .view());
}

} // namespace

int run_swarm(SwarmOf of, int count, char** words) {
    const std::string_view name = of.machine.table.name;
    if (prints_version(count, words, name)) return none_broken;
    const std::vector<std::string_view> all(words + 1, words + count);
    const auto given = read_command_line(options, all, Others::refused);
    if (!given) {
        static_cast<void>(os::write_all(2, Sentence{name, " swarm: ", given.error(), "\n"}.view()));
        return wrong_words;
    }
    if (given->has("--help")) {
        os::print(Sentence{"the machine \"", name, "\" while everything around it goes wrong\n"}.view());
        os::print(usage_of(options));
        return none_broken;
    }
    tell_unjudged(of.machine.table);
    silence_machine();
    install_contract_handler(tell_contract);
    const SwarmRun::Tell tell = given->has("--seed") ? print_timed : SwarmRun::Tell{};
    const Duration wanted = given->has("--minutes") ? given->number("--minutes", 0) * Duration{1min}
                                                    : given->number("--hours", 1) * Duration{1h};
    std::uint64_t seed = given->number(given->has("--seed") ? "--seed" : "--from", 1);
    AllLeftBehind left;
    if (!of.rules) {
        left = SwarmRun{of, 0}.learn();
        of.left = &left;
    }
    const Duration began = os::processor_time_of_this_thread();
    Totals totals;
    totals.usual.resize(of.machine.table.activities.size());
    totals.responses = totals.usual;
    if (given->has("--anyone")) of.rules = {};
    const Duration working = given->number("--working", 0) * Duration{1s};
    const std::uint64_t most_broken = given->number("--findings", swarm_options::usual_findings);
    const auto is_enough = [&] {
        return working > Duration{} ? os::processor_time_of_this_thread() - began >= working
                                    : totals.time >= wanted;
    };
    const bool timed = given->has("--bit-rate");
    die_telling();
    do {
        replay = Sentence{"replay it: ", words[0], " --seed ", seed};
        for (const char* rate : {"--bit-rate", "--data-bit-rate"})
            if (given->has(rate)) replay.add(" ").add(rate).add(" ").add(given->text(rate));
        for (const char* word : {"--calm", "--anyone"})
            if (given->has(word)) replay.add(" ").add(word);
        replay.add("\n");
        ::alarm(longest_seed);
        SwarmRun run{of, seed, tell};
        if (timed)
            run.take_times(seed, {static_cast<std::int64_t>(given->number("--bit-rate", 0)),
                                  static_cast<std::int64_t>(given->number("--data-bit-rate", 0))});
        if (given->has("--calm")) run.be_calm();
        const SwarmVerdict verdict = run.go();
        totals.add(seed, verdict);
        if (!verdict.broken.empty())
            print(Sentence{name, ": seed ", seed, " at ", to_ns(verdict.at) / 1000, " us: ", verdict.broken,
                           "; ", replay}
                      .view());
        if (!verdict.broken.empty() && !tell)
            for (const std::string& each : verdict.before) print("    " + each + "\n");
        seed += given->number("--step", 1);
    } while (!given->has("--seed") && !is_enough() && totals.broken < most_broken);
    ::alarm(0);
    if (timed) totals.print_responses(of.machine);
    totals.print_all(name, os::processor_time_of_this_thread() - began);
    return totals.broken == 0 ? none_broken : one_broken;
}

} // namespace tappet

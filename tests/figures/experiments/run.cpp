// Configures, assigns, arms, runs and stops a machine of the experiments.
#include "tests/figures/experiments/run.hpp"

#include "kernel/machine/worlds/real_world.hpp"
#include "tests/figures/experiments/wiring.hpp"
#include "tests/figures/measure/candidates.hpp"

#include <algorithm>
#include <fstream>
#include <memory>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::experiments {

namespace {

/// Voluntary switches of a thread so far; -1 when the system does not report them.
std::int64_t voluntary_switches(int thread) {
    std::ifstream file{"/proc/self/task/" + std::to_string(thread) + "/status"};
    constexpr std::string_view wanted = "voluntary_ctxt_switches:";
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(wanted)) return std::stoll(line.substr(wanted.size()));
    return -1;
}

/// Counts the sleeps of a thread beyond the one after each cycle: another thread held a resource that it
/// needed.
class Blocking {
public:
    Blocking(const Task& task, const Engine& engine) : task_{task}, engine_{engine} {}
    void begin() { begin_ = balance(); }
    [[nodiscard]] std::int64_t since_begin() const { return std::max<std::int64_t>(0, balance() - begin_); }

private:
    // Reads both numbers while the thread sleeps: no cycle ends in between.
    [[nodiscard]] std::int64_t balance() const {
        std::int64_t switches = 0;
        std::uint64_t before = 0, after = 0;
        for (int attempt = 0; attempt < 100; ++attempt) {
            before = cycles();
            switches = voluntary_switches(task_.thread());
            after = cycles();
            if (before == after) break;
        }
        return switches - static_cast<std::int64_t>(after);
    }
    // Another thread writes it: read again each time.
    [[nodiscard]] std::uint64_t cycles() const {
        figures::clobber();
        return engine_.statistics().cycles;
    }
    const Task& task_;
    const Engine& engine_;
    std::int64_t begin_ = 0;
};

} // namespace

void evaluate(std::span<const Execution> executions, Setting setting, double ns_per_tick,
              std::uint64_t warming_ticks, TaskResult& into) {
    for (std::size_t i = 0; i < executions.size(); ++i) {
        const Execution& now = executions[i];
        if (now.begin - executions.front().begin < warming_ticks) continue;
        const auto ns = [&](std::uint64_t ticks) { return static_cast<double>(ticks) * ns_per_tick; };
        ++into.executions;
        into.latencies.add(ns(now.busy) / 1e3);
        if (i + 1 == executions.size()) break; // its successor was not recorded
        into.periods.add(ns(executions[i + 1].begin - now.begin) / 1e3);
        if (setting == Setting::none) {
            into.copies.add(ns(now.copies));
            if (now.one_message != 0) into.one_message.add(ns(now.one_message));
            if (now.two_messages != 0) into.two_messages.add(ns(now.two_messages));
        }
        if (setting == Setting::locked || setting == Setting::data) into.exchanges.add(ns(now.exchange));
        if (now.sent != 0) into.sends.add(ns(now.sent));
        const auto serving = static_cast<double>(now.serving);
        if (now.served == 1) into.one_served.add(serving);
        if (now.served == 2) into.two_served.add(serving);
        if (now.served != 0) into.served.add(serving);
    }
}

std::string run_experiment(const Application& application, const Circumstances& circumstances, double seconds,
                           Experiment& into) {
    const AcceptedMachine machine = application.machine();
    os::Clock clock{os::Clock::Kind::real};
    const auto instance = std::make_unique<MachineInstance>(machine, clock);
    const auto world = std::make_unique<RealWorld>(*instance);
    if (const auto configured = instance->configure({}); !configured)
        return std::string{configured.error().view()};

    const MachineView& table = machine.table;
    const Wiring wiring{table};
    std::vector<std::vector<Execution>> records(table.components.size());
    std::vector<Task*> tasks;
    std::vector<Blocking> blocking;
    for (std::size_t c = 0; c < table.components.size(); ++c) {
        const std::string_view name = table.components[c].name;
        Engine& engine = instance->engines()[machine.index.activity[c]];
        const double in_a_second = 1.0 / to_seconds(table.activities[machine.index.activity[c]].period);
        records[c].resize(static_cast<std::size_t>((seconds + 1) * in_a_second) + 100);
        Assignment assignment = wiring.of(c);
        assignment.turns_per_ns = circumstances.turns_per_ns;
        assignment.ticks_of_stamps = circumstances.ticks_of_stamps;
        assignment.reactions = &engine.plan().functions[static_cast<std::size_t>(FunctionKind::reactions)];
        assignment.record = records[c];
        Task& task = *tasks.emplace_back(instance->find<Task>(name));
        task.setting.set(into.setting);
        task.assign(assignment);
        blocking.emplace_back(task, engine);
    }

    const auto arming = std::make_unique<os::ArmingReport>(
        std::span{one_processor.only_warned.begin(), one_processor.only_warned.end()});
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    const auto armed = world->arm(*arming, nowhere);
    close(nowhere);
    if (!armed) {
        print(*arming, STDERR_FILENO);
        return "the machine refuses to arm; the reasons stand on standard error";
    }
    const Duration whole{static_cast<std::int64_t>(seconds * 1e9)};
    const Duration warming = warming_of(whole);
    if (!world->start(*armed)) return std::string{world->refusal().view()};
    static_cast<void>(world->supervise(warming));
    for (Blocking& each : blocking) each.begin();
    static_cast<void>(world->supervise(whole));
    std::vector<std::int64_t> blocked;
    for (const Blocking& each : blocking) blocked.push_back(each.since_begin());
    if (world->stop() != 0) return "an activity hung";

    into.application = application.name;
    into.tasks.resize(tasks.size());
    for (std::size_t c = 0; c < tasks.size(); ++c) {
        TaskResult& result = into.tasks[c];
        const ActivityRow& row = table.activities[machine.index.activity[c]];
        result.name = table.components[c].name;
        result.period_us = to_seconds(row.period) * 1e6;
        result.load_us = to_seconds(tasks[c]->load.get()) * 1e6;
        result.real_time = row.real_time;
        result.waited_for_locks += tasks[c]->waited_for_locks();
        result.blocked += blocked[c];
        result.misses += instance->engines()[machine.index.activity[c]].statistics().misses;
        evaluate(tasks[c]->executions(), into.setting, circumstances.ns_per_tick,
                 static_cast<std::uint64_t>(static_cast<double>(warming.count()) / circumstances.ns_per_tick),
                 result);
    }
    return {};
}

} // namespace tappet::experiments

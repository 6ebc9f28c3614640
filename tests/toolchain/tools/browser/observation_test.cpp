// Watching cannot disturb: a motion cycle's execution time while another process reads everything of the
// machine in a loop, against the same cycle of the same run without it (thesis 4.8).
#include "tests/apps/carpet_loom/loom_run.hpp"
#include "toolchain/tools/browser/link.hpp"
#include "toolchain/tools/browser/observer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tappet::browser {
namespace {

using namespace std::chrono_literals;
using Nanoseconds = std::int64_t;

/// Shared memory of the watching and the measuring process.
struct Control {
    std::atomic<int> memory{-1}; ///< the measuring process' descriptor of the machine's memory
    std::atomic<bool> reads{false};
    std::atomic<std::uint64_t> sweeps{0}; ///< passes over every facet and every figure
    std::atomic<std::uint64_t> busy{0};   ///< reads that found the machine in its cycle each time
};

void stay_on(std::size_t processor) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(processor, &set);
    static_cast<void>(::sched_setaffinity(0, sizeof set, &set)); // without it the figures are only noisier
}

/// Body of the watching process.
[[noreturn]] void watch(Control& control) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    stay_on(1);
    while (control.memory.load(std::memory_order_acquire) < 0) std::this_thread::sleep_for(1ms);
    const std::string place =
        "/proc/" + std::to_string(::getppid()) + "/fd/" + std::to_string(control.memory.load());
    const int memory = ::open(place.c_str(), O_RDONLY | O_CLOEXEC);
    const auto block = SharedBlock::map(memory);
    const auto map = block ? MapReader::open(block->bytes())
                           : std::expected<MapReader, std::string>{std::unexpected(block.error().sentence)};
    if (!map) {
        std::fprintf(stderr, "the watcher: %s\n", map.error().c_str());
        ::_exit(1);
    }
    const Observer observer{*map};
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < map->facets().size(); ++i)
        if (map->facets()[i].value_at != 0) all.push_back(i);
    for (;;) {
        if (!control.reads.load(std::memory_order_acquire)) continue;
        for (const Reading& reading : observer.read(all))
            if (reading.busy) control.busy.fetch_add(1, std::memory_order_relaxed);
        for (std::uint32_t i = 0; i < map->figures().size(); ++i)
            if (observer.read_figure(i).busy) control.busy.fetch_add(1, std::memory_order_relaxed);
        control.sweeps.fetch_add(1, std::memory_order_release);
    }
}

/// One run of the loom with its plant under virtual time, the same in each run. The machine is watched in
/// every other block of cycles: in the odd blocks or in the even ones.
class MeasuredRun {
public:
    static constexpr std::size_t cycles = 16'000;
    static constexpr std::size_t block = 400;

    MeasuredRun(Control& control, bool watched_first) : control_{control}, watched_first_{watched_first} {
        took.reserve(cycles);
        watched.reserve(cycles);
    }

    void go() {
        control_.memory = -1;
        const pid_t watcher = ::fork(); // created before the machine's memory: no page of it is copied later
        if (watcher == 0) watch(control_);
        carpet::LoomRun run{loom::Settings{}, 1};
        run.world().run_cycles_by({this, [](void* self, Engine& engine, bool woken) {
                                       static_cast<MeasuredRun*>(self)->cycle(engine, woken);
                                   }});
        const auto started = run.start();
        EXPECT_TRUE(started.has_value()) << started.error().view();
        control_.memory = run.instance().observation().shared_descriptor();
        EXPECT_GE(control_.memory, 0) << "the loom carries no map: is there a browser in its table?";
        for (Duration lived{}; took.size() < cycles && lived < 2 * cycles * 1ms && run.run_for(100ms);)
            lived += 100ms;
        control_.reads = false;
        int status = 0;
        EXPECT_EQ(::waitpid(watcher, &status, WNOHANG), 0) << "the watcher died: " << status;
        ::kill(watcher, SIGKILL);
        ::waitpid(watcher, &status, 0);
        run.stop();
        EXPECT_GT(run.plant().picks(), 50u) << "a machine that does not work is easily watched";
        ASSERT_GE(took.size(), cycles);
    }

    std::vector<Nanoseconds> took{};
    std::vector<bool> watched{}; ///< by a reader that completed at least one pass in this block

private:
    void cycle(Engine& engine, bool woken) {
        if (engine.name() != "motion") return engine.run(woken);
        if (took.size() % block == 0) begin_block();
        const auto begin = std::chrono::steady_clock::now();
        engine.run(woken);
        took.push_back((std::chrono::steady_clock::now() - begin).count());
        watched.push_back(reads_);
    }

    /// Waits until the reader runs, before the first cycle of a watched block, or until it has ended its last
    /// pass.
    void begin_block() {
        reads_ = (took.size() / block % 2 == 0) == watched_first_;
        control_.reads.store(reads_, std::memory_order_release);
        if (!reads_) return std::this_thread::sleep_for(1ms);
        const auto sweeps = control_.sweeps.load();
        const auto end = std::chrono::steady_clock::now() + 5s;
        while (control_.sweeps.load(std::memory_order_acquire) < sweeps + 2) {
            std::this_thread::yield();
            if (std::chrono::steady_clock::now() < end) continue;
            reads_ = false; // the watcher is gone: go() reports it
            return;
        }
    }

    Control& control_;
    bool watched_first_;
    bool reads_ = false;
};

struct Quantiles {
    double median = 0;
    double p999 = 0;
};

Quantiles quantiles_of(std::vector<Nanoseconds> values) {
    std::ranges::sort(values);
    const auto at = [&values](double part) {
        return static_cast<double>(
            values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))]);
    };
    return {at(0.5), at(0.999)};
}

/// Keeps the shortest time of each cycle over several runs: that removes the host's interruptions, while the
/// reader is in every run.
void keep_best(std::vector<Nanoseconds>& best, std::size_t cycle, Nanoseconds took) {
    best[cycle] = std::min(best[cycle], took);
}

/// The largest accepted loss. A reader on another processor takes cache lines that the machine must fetch
/// back when it writes them: the rare cycle that writes many of them pays a thousandth of its period, the
/// usual one nothing.
constexpr double median_margin = 1.10;
constexpr double resolution_ns = 50; // two readings of the clock
constexpr double p999_margin_ns = 1000;
constexpr int fewest_pairs = 4;
constexpr int most_pairs = 24;

bool within_margin(const Quantiles& alone, const Quantiles& observed) {
    return observed.median <= alone.median * median_margin + resolution_ns &&
           observed.p999 <= alone.p999 + p999_margin_ns;
}

TEST(Observation, reading_everything_in_a_loop_does_not_slow_a_motion_cycle) {
    if (std::thread::hardware_concurrency() < 2)
        GTEST_SKIP() << "one processor: reader and machine take turns";
    void* const shared =
        ::mmap(nullptr, sizeof(Control), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(shared, MAP_FAILED);
    Control& control = *new (shared) Control;
    stay_on(0);

    constexpr Nanoseconds unknown = INT64_MAX;
    std::vector<Nanoseconds> alone(MeasuredRun::cycles, unknown);
    std::vector<Nanoseconds> observed(MeasuredRun::cycles, unknown);
    std::vector<Nanoseconds> raw_alone;
    std::vector<Nanoseconds> raw_observed;
    Quantiles a;
    Quantiles o;
    int pairs = 0;
    // More runs of each kind reduce the host's noise and keep the cost of reading.
    while (pairs < fewest_pairs || (pairs < most_pairs && !within_margin(a, o))) {
        for (const bool watched_first : {true, false}) {
            MeasuredRun run{control, watched_first};
            run.go();
            if (HasFatalFailure()) return;
            for (std::size_t k = 0; k < MeasuredRun::cycles; ++k) {
                (run.watched[k] ? raw_observed : raw_alone).push_back(run.took[k]);
                keep_best(run.watched[k] ? observed : alone, k, run.took[k]);
            }
        }
        ++pairs;
        a = quantiles_of(alone);
        o = quantiles_of(observed);
    }
    const Quantiles raw_a = quantiles_of(raw_alone);
    const Quantiles raw_o = quantiles_of(raw_observed);
    std::vector<Nanoseconds> differences(alone.size());
    for (std::size_t k = 0; k < alone.size(); ++k) differences[k] = observed[k] - alone[k];
    const Quantiles d = quantiles_of(differences);
    std::printf(
        "motion cycle, %zu cycles, each measured %d times alone and %d times observed; %llu sweeps of all "
        "values\n"
        "  best of each cycle: alone    median %.0f ns, p99.9 %.0f ns\n"
        "                      observed median %.0f ns, p99.9 %.0f ns; paired difference median %+.0f ns\n"
        "  all of them:        alone    median %.0f ns, p99.9 %.0f ns\n"
        "                      observed median %.0f ns, p99.9 %.0f ns\n"
        "  margin: median %.0f %% and %.0f ns of resolution, p99.9 %.0f ns; busy readings: %llu\n",
        alone.size(), pairs, pairs, static_cast<unsigned long long>(control.sweeps.load()), a.median, a.p999,
        o.median, o.p999, d.median, raw_a.median, raw_a.p999, raw_o.median, raw_o.p999,
        100 * (median_margin - 1), resolution_ns, p999_margin_ns,
        static_cast<unsigned long long>(control.busy.load()));
    EXPECT_GT(control.sweeps.load(), 100u) << "the reader hardly ran: nothing was measured";
    EXPECT_LE(o.median, a.median * median_margin + resolution_ns);
    // When the host alone delays more than one cycle in a thousand, the tail belongs to the host.
    if (raw_a.p999 > a.p999 + p999_margin_ns)
        std::printf("  the host is too busy for the tail to be judged\n");
    else
        EXPECT_LE(o.p999, a.p999 + p999_margin_ns);
    ::munmap(shared, sizeof(Control));
}

} // namespace
} // namespace tappet::browser

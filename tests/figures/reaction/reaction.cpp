// The reaction path on this machine: the lateness of a periodic activity, beside cyclictest's loop, and the
// time of an event into another activity, beside a bare futex.
#include "kernel/machine/accept.hpp"
#include "kernel/machine/worlds/real_world.hpp"
#include "kernel/os/sleep.hpp"
#include "tests/figures/measure/candidates.hpp"
#include "tests/figures/measure/equivalence.hpp"
#include "tests/figures/reaction/cyclictest.hpp"
#include "tests/figures/reaction/machine.hpp"

#include <cstdio>
#include <memory>

namespace tappet::figures::reaction {

namespace {

constexpr double margin = 0.05;
constexpr std::size_t warming = 4; ///< first cycles of a block, left out because both sides have just been
                                   ///< started

constinit os::Clock machine_clock{os::Clock::Kind::real};

struct Rig {
    MachineInstance instance{AtRunTime<table, board, bound>::machine(), machine_clock};
    RealWorld world{instance};
    os::ArmingReport report{{board.only_warned.begin(), board.only_warned.end()}};
    BareTicker bare_ticker{};
    BareReceiver bare_near{}, bare_far{};

    Ticker& ticker() { return *instance.find<Ticker>("ticker"); }
    Sender& sender() { return *instance.find<Sender>("sender"); }
    int priority(std::size_t activity) { return instance.machine().plan.activities[activity].priority; }

    /// Starts everything. Empty: it runs; else the reason why not.
    std::string start() {
        if (const auto configured = instance.configure({}); !configured)
            return std::string{configured.error().view()};
        sender().to_near = {&instance.find<Receiver>("near")->arrival, &bare_near};
        sender().to_far = {&instance.find<Receiver>("far")->arrival, &bare_far};
        const auto armed = world.arm(report, 2);
        if (!armed) return "the machine could not be armed: the reason stands above";
        std::string refused;
        refused += bare_ticker.start(there, priority(reaction::ticker), period.count());
        refused += bare_near.start(here, priority(reaction::near));
        refused += bare_far.start(there, priority(reaction::far));
        if (!refused.empty()) return "a bare thread was refused: " + refused;
        if (!world.start(*armed)) return std::string{world.refusal().view()};
        for (const std::size_t activity : {reaction::ticker, reaction::sender})
            turn(activity, LifeChange::stop);
        return {};
    }
    void turn(std::size_t activity, LifeChange change) {
        if (const Sentence refused = world.change_activity(activity, change); !refused.empty())
            std::fprintf(stderr, "%.*s\n", static_cast<int>(refused.size()), refused.characters);
    }
    ~Rig() {
        static_cast<void>(world.stop());
        bare_ticker.end();
        bare_near.end();
        bare_far.end();
    }
};

// ---- periodic

std::vector<double> late_in(const TickBlock& block) {
    return {block.late_ns().begin() + warming, block.late_ns().end()};
}
void wait_until_full(const TickBlock& block) {
    os::sleep_for(period * static_cast<std::int64_t>(TickBlock::capacity));
    while (!block.full()) os::sleep_for(1ms);
}
std::vector<double> tick_ours(Rig& rig) {
    TickBlock& block = rig.ticker().block;
    block.clear();
    rig.turn(reaction::ticker, LifeChange::start);
    wait_until_full(block);
    rig.turn(reaction::ticker, LifeChange::stop);
    return late_in(block);
}
std::vector<double> tick_bare(Rig& rig) {
    rig.bare_ticker.go();
    wait_until_full(rig.bare_ticker.block());
    return late_in(rig.bare_ticker.block());
}

void measure_periodic(Rig& rig, const Options& options, Result& result) {
    Random random{2};
    std::vector<PairOfBlocks> pairs(
        static_cast<std::size_t>(options.setting == "smoke" ? 2 : 220 * options.scale()));
    for (PairOfBlocks& pair : pairs) {
        const bool bare_first = random.below(2) == 0;
        // The phase of the blocks against the kernel's tick is random.
        os::sleep_for(Duration{random.between(0, 4'000'000)});
        if (bare_first) pair.theirs = tick_bare(rig);
        os::sleep_for(Duration{random.between(0, 4'000'000)});
        pair.ours = tick_ours(rig);
        if (!bare_first) pair.theirs = tick_bare(rig);
    }
    const Samples ours = all_of(pairs, &PairOfBlocks::ours), theirs = all_of(pairs, &PairOfBlocks::theirs);
    Figure figure{.id = "reaction.periodic",
                  .title = "periodic wake-up: how late the user's code begins",
                  .source = "thesis A.2; the method of cyclictest",
                  .how = "one cycle of 500 us, in blocks of 100 in turns, both with the latency lock",
                  .rows = {{"Tappet: step of a periodic activity", Standing::ours, ours.summary(), {}},
                           {"clock_nanosleep, clock_gettime", Standing::floor, theirs.summary(), {}}}};
    const std::size_t loops =
        options.setting == "smoke" ? 50 : static_cast<std::size_t>(10'000 * options.scale());
    const Outcome packaged = run_cyclictest(there, rig.priority(reaction::ticker),
                                            static_cast<std::size_t>(period.count() / 1000), loops);
    if (packaged.why_not.empty())
        figure.rows.push_back({"cyclictest, afterwards", Standing::peer, packaged.late_ns.summary(), {}});
    else
        result.notes.push_back(packaged.why_not);
    result.figures.push_back(figure);
    for (const auto& [q, name] : {std::pair{0.5, "median"}, std::pair{0.99, "p99"}}) {
        const Comparison found = compare(pairs, q, margin);
        result.goals.push_back(
            {std::string{"periodic wake-up lateness: equivalent to cyclictest's within 5 % at "} + name,
             1 + margin, found.worst() > 0 ? found.worst() : 99, "x",
             "the interval's further edge; " + found.text()});
    }
    result.plots.push_back(
        histogram_plot("reaction.periodic", "lateness of periodic wake-ups", "lateness [ns]", "cycles",
                       {histogram("Tappet", Standing::ours, ours, 100, 0.999),
                        histogram("clock_nanosleep", Standing::floor, theirs, 100, 0.999)}));
}

// ---- from one activity to another

void measure_handover(Rig& rig, const Options& options, Sender::Reach reach, Result& result) {
    const bool is_far = reach == Sender::Reach::far;
    Sender& sender = rig.sender();
    std::vector<PairOfBlocks> pairs(
        static_cast<std::size_t>(options.setting == "smoke" ? 20 : 1500 * options.scale()));
    std::size_t lost = 0;
    rig.turn(reaction::sender, LifeChange::start);
    for (PairOfBlocks& pair : pairs) {
        sender.reach.store(reach, std::memory_order_release);
        while (sender.reach.load(std::memory_order_acquire) != Sender::Reach::none) os::sleep_for(500us);
        for (std::size_t i = 0; i < Sender::pairs_in_cycle; ++i) {
            const double ours = static_cast<double>(sender.took_ours[i]),
                         bare = static_cast<double>(sender.took_bare[i]);
            if (ours == 0 || bare == 0) {
                ++lost;
                continue;
            }
            pair.ours.push_back((ours - ticks_of_reading()) * ns_per_tick());
            pair.theirs.push_back((bare - ticks_of_reading()) * ns_per_tick());
        }
    }
    rig.turn(reaction::sender, LifeChange::stop);
    const std::string where = is_far ? "two cores" : "one core";
    if (lost != 0)
        result.notes.push_back("event across activities, " + where + ": " + std::to_string(lost) +
                               " pairs of which one took more than a millisecond are left out");
    const Samples ours = all_of(pairs, &PairOfBlocks::ours), theirs = all_of(pairs, &PairOfBlocks::theirs);
    const std::string id = is_far ? "reaction.event.two_cores" : "reaction.event.one_core";
    result.figures.push_back(
        {.id = id,
         .title =
             "event into a sleeping activity, " + where + ": emission to the first line of its operation",
         .source = "thesis 4.6.2",
         .how = "one emission; ours and the bare one by turns, in an order drawn by chance",
         .rows = {{"Tappet: emit to operation", Standing::ours, ours.summary(), {}},
                  {"bare futex: store and wake to load", Standing::floor, theirs.summary(), {}}}});
    const Comparison found = compare(pairs, 0.5, margin);
    result.goals.push_back({"wake of an event-driven activity, " + where + ": <= 1.05 x the bare futex", 1.05,
                            found.ratio, "x", found.text()});
    result.plots.push_back(histogram_plot(id, "event into a sleeping activity, " + where,
                                          "emission to operation [ns]", "emissions",
                                          {histogram("Tappet", Standing::ours, ours, 100, 0.995),
                                           histogram("bare futex", Standing::floor, theirs, 100, 0.995)}));
}

int run(int argc, char** argv) {
    const Options options = read_options(argc, argv);
    Result result{.program = "reaction", .setting = options.setting};
    static_cast<void>(ns_per_tick());
    static_cast<void>(ticks_of_reading());
    {
        auto rig = std::make_unique<Rig>();
        if (const std::string refused = rig->start(); !refused.empty())
            result.notes.push_back("the reaction path was not measured: " + refused);
        else {
            if (options.wants("reaction.event.one_core"))
                measure_handover(*rig, options, Sender::Reach::near, result);
            if (options.wants("reaction.event.two_cores"))
                measure_handover(*rig, options, Sender::Reach::far, result);
            if (options.wants("reaction.periodic")) measure_periodic(*rig, options, result);
        }
    }
    return finish(options, result);
}

} // namespace

} // namespace tappet::figures::reaction

int main(int argc, char** argv) { return tappet::figures::reaction::run(argc, argv); }

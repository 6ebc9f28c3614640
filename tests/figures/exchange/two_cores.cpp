// Rounds in which all subjects take turns in a random order, and their evaluation.
#include "tests/figures/exchange/exchange.hpp"

#include "tests/figures/exchange/iceoryx.hpp"
#include "tests/figures/exchange/pair_of_threads.hpp"
#include "tests/figures/exchange/subjects.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <random>
#include <thread>

namespace tappet::figures {

namespace {

enum class Mode : std::uint8_t { paced, alone, contended, stream };
using Meet = Meeting (*)(const MeetingPlan&);

/// One subject in one rhythm, and the results of each round.
struct Entry {
    const char* name = nullptr;
    Standing role = Standing::ours;
    bool queue = false;
    Mode mode = Mode::paced;
    Meet run = nullptr;
    std::vector<Meeting> rounds = {};
};

template <class Subject, bool queue>
void add(std::vector<Entry>& entries, bool streams = queue) {
    const auto add_one = [&](Mode mode, Meet run) {
        entries.push_back({Subject::name, Subject::role, queue, mode, run});
    };
    add_one(Mode::paced, &meet_paced<Subject>);
    add_one(Mode::alone, &write_alone<Subject, queue>);
    add_one(Mode::contended, &meet_contended<Subject>);
    if constexpr (queue)
        if (streams) add_one(Mode::stream, &meet_in_a_stream<Subject>);
}

using Ours = Port<160, Reach::far>;
using OurQueue = Buffer<160, Reach::far>;
using Apart = BareHandOver<160, true>;
using Beside = BareHandOver<160, false>;
/// The same bare loops a second time: between the queues they have the same neighbours as the queues.
struct BesideQueues : Beside {};

std::vector<Entry> subjects(bool with_iceoryx) {
    std::vector<Entry> entries;
    add<Ours, false>(entries);
    add<Apart, false>(entries);
    add<Beside, false>(entries);
    add<LockedValue<160, PlainLock>, false>(entries);
    add<LockedValue<160, InheritingLock>, false>(entries);
    if (with_iceoryx) add<Iceoryx<160, false>, false>(entries);
    add<OurQueue, true>(entries);
    add<BesideQueues, true>(entries, false); // it overwrites packets that nobody took: no stream
    add<BoostSpsc<160>, true>(entries);
    add<BoostQueue<160>, true>(entries);
    add<LockedQueue<160, PlainLock>, true>(entries);
    add<LockedQueue<160, InheritingLock>, true>(entries);
    if (with_iceoryx) add<Iceoryx<160, true>, true>(entries, false); // it drops the oldest: no stream
    return entries;
}

/// Which samples of a meeting a figure shows.
using Part = Samples Meeting::*;

class Findings {
public:
    explicit Findings(const std::vector<Entry>& entries) : entries_{entries} {}

    [[nodiscard]] const Entry& of(const char* name, bool queue, Mode mode) const {
        return *std::ranges::find_if(entries_, [&](const Entry& entry) {
            return std::string_view{entry.name} == name && entry.queue == queue && entry.mode == mode;
        });
    }
    [[nodiscard]] Figure figure(std::string id, std::string title, bool queue, Mode mode, Part part,
                                std::string how) const {
        Figure figure{std::move(id), std::move(title), "ns", "thesis 4.4", std::move(how), {}};
        for (const Entry& entry : entries_) {
            if (entry.queue != queue || entry.mode != mode) continue;
            Samples all;
            for (const Meeting& round : entry.rounds) all.add(round.*part);
            figure.rows.push_back({entry.name, entry.role, all.summary()});
        }
        return figure;
    }

private:
    const std::vector<Entry>& entries_;
};

double median_of(const Meeting& round, Part part) { return (round.*part).median(); }
double p999_of(const Meeting& round, Part part) { return (round.*part).quantile(0.999); }

/// The median over the rounds of `value`.
template <class Value>
double over_rounds(std::size_t rounds, Value&& value) {
    Samples ratios;
    for (std::size_t round = 0; round < rounds; ++round) ratios.add(value(round));
    return ratios.median();
}

void judge(const Findings& found, std::size_t rounds, Result& result) {
    const auto goal = [&](std::string text, double limit, std::string detail, auto&& value) {
        result.goals.push_back({std::move(text), limit, over_rounds(rounds, value), "x", std::move(detail)});
    };
    const auto& ours = found.of(Ours::name, false, Mode::paced).rounds;
    const auto& apart = found.of(Apart::name, false, Mode::paced).rounds;
    const auto& beside = found.of(Beside::name, false, Mode::paced).rounds;
    const auto& mutex = found.of(PlainLock::name, false, Mode::paced).rounds;
    const auto& alone = found.of(Ours::name, false, Mode::alone).rounds;
    goal("data, 160 bytes, two cores: write to value seen at most 1.3 x the floor", 1.3,
         "exchange.two_cores.data.seen.160: ours / the faster of the two bare loops", [&](std::size_t r) {
             return median_of(ours[r], &Meeting::seen) /
                    std::min(median_of(apart[r], &Meeting::seen), median_of(beside[r], &Meeting::seen));
         });
    goal("data, 160 bytes, two cores: write to value seen at most 0.5 x a mutex", 0.5,
         "exchange.two_cores.data.seen.160: ours / std::mutex", [&](std::size_t r) {
             return median_of(ours[r], &Meeting::seen) / median_of(mutex[r], &Meeting::seen);
         });
    goal("writer of that connector while a reader polls it: at most 3 x its undisturbed time", 3,
         "exchange.two_cores.data.write_polled.160 / exchange.two_cores.data.write_alone.160",
         [&](std::size_t r) {
             return median_of(ours[r], &Meeting::give) / median_of(alone[r], &Meeting::give);
         });

    struct Contended {
        const char* what;
        const char* figure;
        bool queue;
        Part part;
    };
    for (const Contended& each : {Contended{"data, write", "data.write_contended", false, &Meeting::give},
                                  {"data, read", "data.read_contended", false, &Meeting::take},
                                  {"buffer, push", "buffer.push_contended", true, &Meeting::give},
                                  {"buffer, pop", "buffer.pop_contended", true, &Meeting::take}}) {
        const auto& our =
            found.of(each.queue ? OurQueue::name : Ours::name, each.queue, Mode::contended).rounds;
        const auto& floor = found.of(Beside::name, each.queue, Mode::contended).rounds;
        goal(std::string{"two-core contention, p99.9 of every exchange within 2 x the floor's: "} + each.what,
             2, std::string{"exchange.two_cores."} + each.figure + ".160: p99.9 of ours / of the bare loop",
             [&](std::size_t r) { return p999_of(our[r], each.part) / p999_of(floor[r], each.part); });
    }
    const auto& queue = found.of(OurQueue::name, true, Mode::contended).rounds;
    const auto& boost = found.of(BoostSpsc<160>::name, true, Mode::contended).rounds;
    const auto push_and_pop = [](const Meeting& round) {
        return median_of(round, &Meeting::give) + median_of(round, &Meeting::take);
    };
    goal("buffer push + pop, 160 bytes: at most 0.8 x boost spsc_queue on two cores (each operation)", 0.8,
         "exchange.two_cores.buffer: push_contended + pop_contended, ours / boost::lockfree::spsc_queue",
         [&](std::size_t r) { return push_and_pop(queue[r]) / push_and_pop(boost[r]); });
    const auto& stream = found.of(OurQueue::name, true, Mode::stream).rounds;
    const auto& boosts = found.of(BoostSpsc<160>::name, true, Mode::stream).rounds;
    goal("buffer push + pop, 160 bytes: at most 0.8 x boost spsc_queue on two cores (a stream, for each "
         "packet)",
         0.8, "exchange.two_cores.buffer.stream.160: ours / boost::lockfree::spsc_queue", [&](std::size_t r) {
             return median_of(stream[r], &Meeting::stream) / median_of(boosts[r], &Meeting::stream);
         });
}

void show(const Findings& found, const Clocks& clocks, Result& result) {
    constexpr const char* paced = "one packet at a time, the other side polls without a pause";
    constexpr const char* busy = "both sides without a pause, each operation timed that did its work";
    const auto add = [&](const char* id, const char* title, bool queue, Mode mode, Part part,
                         const char* how) {
        result.figures.push_back(found.figure(std::string{"exchange.two_cores."} + id + ".160",
                                              std::string{title} + ", 160 bytes, two cores", queue, mode,
                                              part, how));
    };
    add("data.seen", "data: write to value seen", false, Mode::paced, &Meeting::seen, paced);
    result.figures.back().rows.push_back(
        {"a line written in turns, one way", Standing::floor, clocks.one_way_ns.summary()});
    add("data.write_alone", "data: write, undisturbed", false, Mode::alone, &Meeting::give,
        "one write each microsecond");
    add("data.write_polled", "data: write while a reader polls", false, Mode::paced, &Meeting::give, paced);
    add("data.write_contended", "data: write under contention", false, Mode::contended, &Meeting::give, busy);
    add("data.read_contended", "data: read of a new value under contention", false, Mode::contended,
        &Meeting::take, busy);
    add("buffer.seen", "buffer: push to packet popped", true, Mode::paced, &Meeting::seen, paced);
    add("buffer.push_polled", "buffer: push while a reader polls", true, Mode::paced, &Meeting::give, paced);
    add("buffer.push_contended", "buffer: push under contention", true, Mode::contended, &Meeting::give,
        busy);
    add("buffer.pop_contended", "buffer: pop under contention", true, Mode::contended, &Meeting::take, busy);
    result.figures.push_back(found.figure(
        "exchange.two_cores.buffer.stream.160",
        "buffer: a stream of packets of 160 bytes between two cores, for each packet", true, Mode::stream,
        &Meeting::stream, "one sample: the mean of a stream of some thousand packets"));
}

} // namespace

void measure_two_cores(const Options& options, bool with_iceoryx, Result& result) {
    if (!options.wants("exchange.two_cores")) return;
    if (std::thread::hardware_concurrency() < 2) {
        result.notes.push_back("exchange.two_cores.*: not measured, this machine has one processor");
        return;
    }
    const auto rounds = static_cast<std::size_t>(std::max(3.0, 9 * std::min(3.0, options.scale())));
    MeetingPlan plan;
    plan.packets =
        std::max<std::size_t>(100, static_cast<std::size_t>(2000 * std::min(4.0, options.scale())));
    const std::string refused = meet([] {}, [] {});
    if (!refused.empty()) result.notes.push_back("two threads; the system refused: " + refused);

    const Clocks clocks = compare_clocks(plan.packets);
    plan.clock_ahead_ticks = clocks.ahead_ticks;
    char note[160];
    std::snprintf(
        note, sizeof note,
        "exchange.two_cores: the second processor's time stamps are %.1f ns ahead of the first's, which is "
        "taken off",
        clocks.ahead_ticks * ns_per_tick());
    result.notes.emplace_back(note);
    std::vector<Entry> entries = subjects(with_iceoryx);
    std::vector<Entry*> turns;
    for (Entry& entry : entries) turns.push_back(&entry);
    std::minstd_rand random{1};
    for (std::size_t round = 0; round < rounds; ++round) {
        std::ranges::shuffle(turns, random);
        for (Entry* entry : turns) entry->rounds.push_back(entry->run(plan));
    }
    const Findings found{entries};
    show(found, clocks, result);
    judge(found, rounds, result);
}

} // namespace tappet::figures

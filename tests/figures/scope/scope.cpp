// The cost of recording every cycle: an engine's step with the thread scope on, switched off and not in the
// table at all, beside the time stamps that the engine takes anyway (thesis A.2.1).
#include "kernel/machine/accept.hpp"
#include "tests/figures/scope/machine.hpp"

#include <array>
#include <cstdio>

namespace tappet::figures {

namespace {

constexpr auto origin = "thesis A.2.1";

// clang-format off
constexpr auto one_bare = machine("one",
    components(component<Idle>("a")),
    activities(activity("motion", on_work(), at_most(1, 1us), deadline(1s), budget(100ns), runs("a"))), connections(), reactions(when("a.kicks", tell("a.kick"))), behaviours());
constexpr auto one_scoped = machine("one",
    components(component<Idle>("a"), component<ThreadScope>("scope")),
    activities(activity("motion", on_work(), at_most(1, 1us), deadline(1s), budget(100ns), runs("a")),
               activity("background", every(20ms), not_real_time, runs("scope"))), connections(), reactions(when("a.kicks", tell("a.kick"))), behaviours());
constexpr auto ten_bare = machine("ten",
    components(component<Idle>("a"), component<Idle>("b"), component<Idle>("c"), component<Idle>("d"), component<Idle>("e"),
               component<Idle>("f"), component<Idle>("g"), component<Idle>("h"), component<Idle>("i"), component<Idle>("j")),
    activities(activity("motion", on_work(), at_most(1, 1us), deadline(1s), budget(100ns),
                        runs("a", "b", "c", "d", "e", "f", "g", "h", "i", "j"))), connections(), reactions(when("a.kicks", tell("a.kick"))), behaviours());
constexpr auto one_off = one_scoped; // in memory of their own
constexpr auto ten_off = ten_scoped;
constexpr auto one_timeless = one_bare;
constexpr auto one_timeless_scoped = one_scoped;
constexpr auto looked_at = ten_scoped;
// clang-format on

/// As its activity does it at each wake-up.
template <const auto& table, os::Clock::Kind kind, bool off = false>
void step(std::size_t times) {
    static World world{kind, AtRunTime<table, figures_board>::machine()};
    if constexpr (off) scope::tape(directory_of(world), 0).turn(false);
    Engine& engine = world.engine();
    for (std::size_t i = 0; i < times; ++i) engine.run(true);
}

alignas(CycleTape::alignment) std::array<std::byte, CycleTape::bytes_for(4096)> tape_memory;
CycleTape& tape() {
    static CycleTape& placed = *new (tape_memory.data()) CycleTape{4096};
    return placed;
}
void mark(std::size_t times) {
    CycleTape& into = tape();
    for (std::size_t i = 0; i < times; ++i) {
        if (i % 8 == 0) into.begin();
        into.mark(static_cast<std::uint32_t>(i % 8), static_cast<std::int64_t>(i));
    }
}
std::array<std::uint64_t, 4096> plain{};
void plain_store(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        plain[i % plain.size()] = i;
        clobber();
    }
}

/// The background's share: it evaluates all new records, cycle by cycle.
World& watched() {
    static World world{os::Clock::Kind::real, AtRunTime<looked_at, figures_board>::machine()};
    return world;
}
void run_cycles(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) watched().engine().run(true);
}
void look(std::size_t) {
    auto* scope = watched().instance.find<ThreadScope>("scope");
    scope->after.set(Duration::zero());
    scope->work({.now = watched().clock.now()});
}
void walk_words(std::size_t times) {
    const CycleTape& tape = scope::tape(directory_of(watched()), 0);
    TapeCycle cycle;
    std::uint64_t after = tape.head();
    for (std::size_t i = 0; i < times && tape.cycle_before(after, cycle); ++i) after = cycle.at;
    keep(after);
}

std::vector<Group> groups() {
    using Kind = os::Clock::Kind;
    std::vector<Group> all;
    all.push_back({"scope.step.1",
                   "step of an engine with one component",
                   origin,
                   64,
                   {{"recorded", Standing::ours, &step<one_scoped, Kind::real>},
                    {"recording switched off", Standing::ours, &step<one_off, Kind::real, true>},
                    {"no scope in the table", Standing::floor, &step<one_bare, Kind::real>},
                    {"its two time stamps alone", Standing::floor, &read_clock<2>}}});
    all.push_back({"scope.step.10",
                   "step of an engine with ten components",
                   origin,
                   16,
                   {{"recorded", Standing::ours, &step<ten_scoped, Kind::real>},
                    {"recording switched off", Standing::ours, &step<ten_off, Kind::real, true>},
                    {"no scope in the table", Standing::floor, &step<ten_bare, Kind::real>},
                    {"its eleven time stamps alone", Standing::floor, &read_clock<11>}}});
    all.push_back({"scope.step.timeless",
                   "step of an engine with one component whose clock costs nothing",
                   origin,
                   64,
                   {{"recorded", Standing::ours, &step<one_timeless_scoped, Kind::virtual_time>},
                    {"no scope in the table", Standing::floor, &step<one_timeless, Kind::virtual_time>}}});
    all.push_back({"scope.mark",
                   "mark of one function on its activity's tape",
                   origin,
                   64,
                   {{"mark", Standing::ours, &mark},
                    {"store of one word", Standing::floor, &plain_store},
                    {"time stamp", Standing::floor, &read_clock<1>}}});
    all.push_back({"scope.look",
                   "background: one recorded cycle of ten functions looked at",
                   origin,
                   64,
                   {{"judged by the flight recorder", Standing::ours, &look, &run_cycles},
                    {"walked over", Standing::floor, &walk_words, &run_cycles}}});
    return all;
}

std::string ns(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.2f ns", value);
    return text.data();
}

/// Compares the medians of the same run.
void add_statements(Result& result) {
    const Row* recorded = result.find("scope.step.10", "recorded");
    const Row* off = result.find("scope.step.10", "recording switched off");
    const Row* without = result.find("scope.step.10", "no scope in the table");
    const Row* mark = result.find("scope.mark", "mark");
    const Row* stamp = result.find("scope.mark", "time stamp");
    if (recorded == nullptr || off == nullptr || without == nullptr || mark == nullptr || stamp == nullptr)
        return;
    const double added = recorded->summary.median - without->summary.median;
    result.statements.push_back(
        {"recording every function of a cycle of ten costs less than one time stamp of the "
         "eleven that are taken anyway",
         added < stamp->summary.median,
         ns(added) + " more than " + ns(without->summary.median) + "; a stamp costs " +
             ns(stamp->summary.median)});
    const double idle = off->summary.median - without->summary.median;
    result.statements.push_back(
        {"switched off it costs nothing that can be measured: less than 2 % of a step",
         idle < 0.02 * without->summary.median, ns(idle) + " more than " + ns(without->summary.median)});
    result.statements.push_back({"a mark costs less than a tenth of the time stamp that it notes",
                                 mark->summary.median < 0.1 * stamp->summary.median,
                                 ns(mark->summary.median) + " of " + ns(stamp->summary.median)});
    const auto subtracted = static_cast<double>(directory_of(watched()).stamp_ns);
    result.statements.push_back(
        {"the cost of a stamp that the scope subtracts, found at start-up, is within 20 % of "
         "what is measured here (the thesis: 3174 ns, a system call)",
         subtracted > 0.8 * stamp->summary.median && subtracted < 1.2 * stamp->summary.median,
         ns(subtracted) + " subtracted, " + ns(stamp->summary.median) + " measured"});
}

} // namespace

} // namespace tappet::figures

int main(int argc, char** argv) {
    using namespace tappet::figures;
    const Options options = read_options(argc, argv);
    Result result{.program = "scope", .setting = options.setting};
    run_candidates(options, argv, groups(), result);
    if (options.wants("scope.followed")) add_followed(options, result);
    add_statements(result);
    return finish(options, result);
}

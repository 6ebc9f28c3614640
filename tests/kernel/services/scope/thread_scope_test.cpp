// The thread scope and flight recorder (thesis A.2.1) in virtual time, where every cycle takes exactly the
// time of its components.
#include "kernel/services/scope/thread_scope.hpp"

#include "tests/kernel/machine/virtual_rig.hpp"

#include <algorithm>
#include <vector>

namespace tappet {
namespace {

struct Worker : Clocked {
    Event<> done;
    Duration load = 10us;
    std::int64_t steps = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        ++steps;
        clock->consume(load);
        done();
    }
    static constexpr auto interface() { return facets(event<&Worker::done>("done", "a step was made")); }
};

struct Clerk : Clocked {
    void on_done() noexcept TAPPET_REALTIME { clock->consume(3us); }
    static constexpr auto interface() { return facets(operation<&Clerk::on_done>("on_done", "notes it")); }
};

// clang-format off
constexpr auto table = machine("recorded",
    components(component<Worker>("first"), component<Worker>("second"), component<Clerk>("clerk"), component<ThreadScope>("scope", set("span", 4s))),
    activities(
        activity("motion", every(1ms), budget(100us), runs("first", "second")),
        activity("logic",  on_work(), at_most(8, 1ms), deadline(1ms), budget(20us), runs("clerk")),
        activity("background", every(20ms), not_real_time, runs("scope"))),
    connections(),
    reactions(when("first.done", tell("clerk.on_done"))),
    behaviours());
constexpr std::size_t motion = 0, logic = 1, background = 2;
// clang-format on

struct Scope : testing::Test, RunningRig<table> {
    Worker* first = &the<Worker>("first");
    ThreadScope* scope = &the<ThreadScope>("scope");
    scope::Directory* directory = reinterpret_cast<scope::Directory*>(instance.machine().memory.data() +
                                                                      instance.machine().plan.scope_at);

    /// One cycle of motion in which the first worker takes so long.
    void run_slow(Duration load) {
        first->load = load;
        pass(1ms);
        first->load = 10us;
    }
    std::vector<scope::Recording*> kept(std::uint32_t activity) {
        std::vector<scope::Recording*> found;
        for (std::uint32_t i = 0; i < directory->recordings; ++i)
            if (auto& each = scope::recording(*directory, i); each.serial != 0 && each.activity == activity)
                found.push_back(&each);
        std::ranges::sort(found, std::ranges::greater{}, &scope::Recording::rank_ns);
        return found;
    }
};

TEST_F(Scope, records_each_cycle_function_by_function) {
    pass(3500us);
    const CycleTape& tape = scope::tape(*directory, motion);
    TapeCycle cycle;
    ASSERT_TRUE(tape.cycle_before(tape.head(), cycle));
    EXPECT_EQ(cycle.busy(), 20'000);
    ASSERT_EQ(cycle.marks, 2u);
    std::array<std::uint64_t, 2> marks{};
    ASSERT_TRUE(tape.copy(cycle.at, marks));
    EXPECT_EQ(TapeMark::of(marks[0]).function, 0 * functions_per_part);
    EXPECT_EQ(TapeMark::of(marks[0]).end, 10'000);
    EXPECT_EQ(TapeMark::of(marks[1]).function, 1 * functions_per_part);
    EXPECT_EQ(TapeMark::of(marks[1]).end, 20'000);
    const CycleTape& other = scope::tape(*directory, logic);
    ASSERT_TRUE(other.cycle_before(other.head(), cycle));
    EXPECT_EQ(cycle.busy(), 3'000);
    std::array<std::uint64_t, 1> mark{};
    ASSERT_TRUE(other.copy(cycle.at, mark));
    EXPECT_EQ(TapeMark::of(mark[0]).function, static_cast<std::uint32_t>(FunctionKind::reactions));
}

TEST_F(Scope, keeps_the_worst_cycle_with_its_surroundings) {
    pass(50ms);
    const Time slow_from = clock.now();
    run_slow(700us);
    pass(50ms);
    const auto worst = kept(motion);
    ASSERT_FALSE(worst.empty());
    EXPECT_EQ(worst[0]->rank_ns, 710'000);
    EXPECT_GT(worst[0]->begin, to_ns(slow_from));
    EXPECT_EQ(worst[0]->from, worst[0]->release - 2'000'000);
    EXPECT_EQ(worst[0]->to, worst[0]->end + 2'000'000);
    // Each block holds whole cycles of one activity.
    std::array<std::size_t, 3> cycles{};
    const std::uint64_t* words = scope::words_of(*worst[0]);
    for (std::uint32_t at = 0; at < worst[0]->words;) {
        const auto activity = static_cast<std::size_t>(words[at] >> 48);
        const auto count = static_cast<std::uint32_t>(words[at] & 0xffffffff);
        ASSERT_LT(activity, cycles.size());
        ASSERT_LE(at + 1 + count, worst[0]->words);
        for (std::uint32_t after = count; after > 0; ++cycles[activity]) {
            const std::uint64_t* end = words + at + 1 + after;
            const TapeCycle cycle = cycle_of(end[-3], end[-2], end[-1], after);
            EXPECT_GE(cycle.end, worst[0]->from);
            EXPECT_LE(cycle.begin, worst[0]->to);
            ASSERT_LE(cycle.words(), after);
            after -= static_cast<std::uint32_t>(cycle.words());
        }
        at += 1 + count;
    }
    EXPECT_GE(cycles[motion], 4u);
    EXPECT_GE(cycles[logic], 4u);
}

TEST_F(Scope, keeps_the_worst_two_cycles_of_each_part_of_the_span) {
    pass(1s);
    run_slow(300us);
    pass(10ms);
    run_slow(500us);
    pass(10ms);
    run_slow(400us);
    pass(100ms);
    const auto worst = kept(motion);
    ASSERT_GE(worst.size(), 2u);
    EXPECT_EQ(worst[0]->rank_ns, 510'000);
    EXPECT_EQ(worst[1]->rank_ns, 410'000);
    EXPECT_LT(worst.size() > 2 ? worst[2]->rank_ns : 0, 310'000) << "the third of this part went";
}

TEST_F(Scope, keeps_the_worst_cycle_until_its_span_is_over) {
    pass(500ms);
    run_slow(600us);
    for (int tenth = 1; tenth < 40; ++tenth) { // of a span of four seconds
        pass(100ms);
        ASSERT_EQ(kept(motion).at(0)->rank_ns, 610'000) << tenth;
    }
    pass(3s);
    EXPECT_LT(kept(motion).at(0)->rank_ns, 610'000) << "what is older gave its place away";
}

TEST_F(Scope, keeps_an_oversized_cycle_with_less_around_it) {
    pass(30ms);
    // Endless messages: every cycle of logic is short, and the window holds many.
    for (int i = 0; i < 20; ++i) {
        first->load = Duration{(i + 1) * 20'000};
        pass(1ms);
    }
    pass(60ms);
    for (const scope::Recording* each : kept(motion)) {
        EXPECT_LE(each->words, scope::recording_words);
        EXPECT_LE(each->from, each->release);
        EXPECT_GE(each->to, each->end);
    }
}

TEST_F(Scope, records_nothing_while_off_and_resumes_when_on_again) {
    pass(50ms);
    scope->on.set(false);
    pass(25ms);
    const std::uint64_t before = scope::tape(*directory, motion).head();
    pass(100ms);
    EXPECT_EQ(scope::tape(*directory, motion).head(), before);
    scope->on.set(true);
    pass(100ms);
    EXPECT_GT(scope::tape(*directory, motion).head(), before);
    EXPECT_EQ(directory->overtaken, 0u);
}

TEST_F(Scope, can_forget_its_kept_cycles) {
    pass(50ms);
    run_slow(700us);
    pass(50ms);
    scope->forget();
    pass(50ms);
    ASSERT_FALSE(kept(motion).empty()) << "it goes on";
    EXPECT_LT(kept(motion).at(0)->rank_ns, 700'000);
}

TEST_F(Scope, ranks_a_late_cycle_by_its_busy_time_only) {
    scope->by_busy.set(true);
    pass(50ms);
    run_slow(1500us); // the next cycle begins late, and is short
    pass(50ms);
    const auto worst = kept(motion);
    ASSERT_GE(worst.size(), 2u);
    EXPECT_EQ(worst[0]->rank_ns, 1'510'000);
    EXPECT_EQ(worst[1]->rank_ns, 20'000);
}

TEST_F(Scope, records_background_cycles_without_ranking_them) {
    pass(100ms);
    EXPECT_GT(scope::tape(*directory, background).head(), 0u);
    EXPECT_TRUE(kept(background).empty());
    EXPECT_GT(directory->judged, 150u);
}

TEST_F(Scope, continues_the_tape_of_a_restarted_activity) {
    pass(50ms);
    ASSERT_EQ(world.change_activity(motion, LifeChange::stop).view(), "");
    pass(50ms);
    ASSERT_EQ(world.change_activity(motion, LifeChange::start).view(), "");
    const std::uint64_t before = scope::tape(*directory, motion).head();
    pass(50ms);
    const CycleTape& tape = scope::tape(*directory, motion);
    EXPECT_GT(tape.head(), before);
    TapeCycle cycle;
    ASSERT_TRUE(tape.cycle_before(tape.head(), cycle));
    EXPECT_EQ(cycle.marks, 2u);
}

} // namespace
} // namespace tappet

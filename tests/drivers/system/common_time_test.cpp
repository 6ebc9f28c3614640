// One time over the nodes of a wire: values keep the time at which they were true, whatever the clocks of
// their nodes show, within the bound that the compiler has proven.
#include "tests/drivers/system/pair.hpp"
#include "toolchain/machine/system_run.hpp"

#include <gtest/gtest.h>

namespace tappet::time_test {
namespace {

/// Sends the time of its own clock.
struct Speaker {
    Output<double> told_at{};
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME { told_at.write(to_seconds(cycle.now - Time{})); }
    static constexpr auto interface() {
        return facets(output<&Speaker::told_at>("told_at", "s", "its time"));
    }
};
struct Listener {
    Input<double> told_at{};
    // As read in the last cycle: outside of a cycle the age of a value is unknown.
    double value = 0;
    bool is_good = false;
    Time stamp{};

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        is_good = told_at.good();
        value = told_at.get();
        stamp = told_at.stamp();
    }
    static constexpr auto interface() {
        return facets(input<&Listener::told_at>("told_at", "s", "as it was told"));
    }
};

// clang-format off
constexpr auto speaks = machine("speaks", components(component<Speaker>("speaker")),
    activities(activity("speaking", every(7ms), runs("speaker"), budget(50us))), connections(), reactions(), behaviours());
constexpr auto listens = machine("listens", components(component<Listener>("listener")),
    activities(activity("listening", every(5ms), runs("listener"), budget(50us))), connections(), reactions(), behaviours());
constexpr auto tells = machine("tells", components(component<Speaker>("speaker")),
    activities(activity("speaking", every(5ms), runs("speaker"), budget(50us))), connections(), reactions(), behaviours());

constexpr auto three = nodes(node<speaks>("a"), node<listens>("b"), node<tells>("clock"));
constexpr auto row = across(data("a.speaker.told_at", "b.listener.told_at", stale_after(60ms), hold), every(10ms),
                            in_natural_bits(35, 1e-6), with_time);
constexpr auto clocked_wire = pair::usual_wire("wire", common_clock("clock", every(100ms), within(200us)));
constexpr auto clocked = system("clocked", three, clocked_wire, crossings(row));
// clang-format on
using Speaks = AtRunTime<station<clocked, "a", speaks>, board::host>;
using Listens = AtRunTime<station<clocked, "b", listens>, board::host>;
using Tells = AtRunTime<station<clocked, "clock", tells>, board::host>;
using ClockOfB = can::ToldClock<systems::StationRows<clocked, 1>::clock_row>;

struct Rig {
    explicit Rig(std::uint64_t seed)
        : random{seed},
          machines{Speaks::machine(), Listens::machine(), Tells::machine()},
          run{clocked.view(), machines, {}, seed} {
        for (std::size_t n = 0; n < 3; ++n) {
            clocks[n] = {Duration{random.between(0, 100'000'000'000)},
                         static_cast<double>(random.between(-100, 100))};
            run.set_clock(n, clocks[n]);
            run.end(n).stamps_late = clocked.wire.clock.stamps_late;
        }
    }
    Listener& listener() { return *run.instance(1).find<Listener>("listener"); }
    /// The difference between the received stamp and the time at which the value was true.
    Duration error() {
        const Time told = clocks[0].true_time(Time{from_seconds(listener().value)});
        return clocks[1].true_time(listener().stamp) - told;
    }
    static Duration from_seconds(double seconds) {
        return Duration{static_cast<std::int64_t>(seconds * 1e9)};
    }

    Random random;
    std::array<AcceptedMachine, 3> machines;
    std::array<ClockFault, 3> clocks{};
    SystemRun run;
};

TEST(CommonTime, keeps_the_time_stamp_of_a_value_between_drifting_clocks) {
    // The errors of both receiving nodes, and the steps of clock and value.
    const Duration bound = 2 * systems::plan_of<clocked>.clock_error + Duration{time_step_ns} + 2us;
    Duration furthest{};
    std::int64_t looks = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        Rig rig{seed};
        ASSERT_TRUE(rig.run.start());
        rig.run.run_for(500ms);
        for (int i = 0; i < 40; ++i) {
            rig.run.run_for(Duration{rig.random.between(1'000'000, 60'000'000)});
            if (!rig.listener().is_good) continue;
            const Duration error = rig.error();
            ASSERT_LE(error, bound) << "seed " << seed;
            ASSERT_GE(error, -bound) << "seed " << seed;
            furthest = std::max({furthest, error, -error});
            ++looks;
        }
        const auto& clock = *rig.run.instance(1).find<ClockOfB>("wire_clock");
        EXPECT_LE(clock.error.last(), systems::plan_of<clocked>.clock_error) << "seed " << seed;
        EXPECT_GT(clock.error.last(), clocked.wire.clock.stamps_late);
        rig.run.stop();
    }
    EXPECT_GT(looks, 1900);
    EXPECT_GT(furthest, 50us) << "stamps are late in this run; nothing of that was seen";
}

TEST(CommonTime, is_invalid_while_no_clock_master_sends) {
    Rig rig{1};
    ASSERT_TRUE(rig.run.start(0) && rig.run.start(1));
    rig.run.run_for(500ms);
    EXPECT_EQ(rig.listener().told_at.flow(), Flow::never_written);
    ASSERT_TRUE(rig.run.start(2));
    rig.run.run_for(500ms);
    EXPECT_TRUE(rig.listener().is_good);
    rig.run.kill(2);
    rig.run.run_for(300ms);
    EXPECT_TRUE(rig.listener().is_good) << "its error grows, but is within what the wire says";
    rig.run.run_for(500ms);
    EXPECT_EQ(rig.listener().told_at.flow(), Flow::stale);
    EXPECT_FALSE(rig.run.instance(1).find<ClockOfB>("wire_clock")->is_known.last());
    ASSERT_TRUE(rig.run.start(2));
    rig.run.run_for(500ms);
    EXPECT_TRUE(rig.listener().is_good);
    rig.run.stop();
}

TEST(CommonTime, follows_only_the_new_time_of_a_restarted_clock_master) {
    // One turn of the sent time, less 40 ms: the old clock would make the times 40 ms older.
    for (const Duration jump :
         {Duration{655'360us - 40ms}, Duration{655'360us + 3ms}, Duration{-300ms}, Duration{7h}}) {
        Rig rig{1};
        ASSERT_TRUE(rig.run.start());
        rig.run.run_for(500ms);
        rig.run.kill(2);
        rig.run.run_for(50ms);
        rig.clocks[2].offset += jump;
        if (rig.clocks[2].offset < Duration::zero()) continue;
        rig.run.set_clock(2, rig.clocks[2]);
        ASSERT_TRUE(rig.run.start(2));
        const Duration bound = 2 * clocked.wire.clock.within + Duration{time_step_ns} + 2us;
        for (int i = 0; i < 500; ++i) {
            rig.run.run_for(1ms);
            if (!rig.listener().is_good) continue;
            ASSERT_LE(rig.error(), bound) << i << " ms after it began";
            ASSERT_GE(rig.error(), -bound) << i << " ms after it began";
        }
        EXPECT_TRUE(rig.listener().is_good);
        rig.run.stop();
    }
}

TEST(CommonTime, classifies_a_time_on_the_wire_as_past_present_or_invalid) {
    const Time now{100s};
    Duration age{};
    for (const Duration ago : {Duration::zero(), Duration{10us}, Duration{491ms}}) {
        EXPECT_TRUE(on_wire::age_of_time(on_wire::tell_time(now - ago), now, 400us, age)) << ago.count();
        EXPECT_EQ(age, ago);
    }
    EXPECT_TRUE(on_wire::age_of_time(on_wire::tell_time(now + 400us), now, 400us, age));
    EXPECT_EQ(age, Duration::zero());
    for (const Duration ago : {Duration{-1ms}, Duration{-100ms}, Duration{492ms}, Duration{600ms}})
        EXPECT_FALSE(on_wire::age_of_time(on_wire::tell_time(now - ago), now, 400us, age)) << ago.count();
}

std::string refusal(const WireRow& wire, const Crossing& crossing) {
    return std::string{
        plan_system(system("lane", three, wire, crossings(crossing)), &systems::analyse_can).fault.view()};
}
TEST(CommonTime, refuses_invalid_clock_rows) {
    EXPECT_EQ(refusal(clocked_wire, row), "");
    EXPECT_EQ(
        refusal(pair::usual_wire("wire"), row),
        "lane: crossing \"a.speaker.told_at\" -> \"b.listener.told_at\" is sent with_time, but wire \"wire\" "
        "has no common time; add common_clock(\"node\", every(100ms), within(200us))");
    EXPECT_EQ(refusal(pair::usual_wire("wire", common_clock("c", every(100ms), within(200us))), row),
              "lane: common_clock(\"c\"): there is no such node; name one of nodes(...)");
    EXPECT_EQ(refusal(pair::usual_wire("wire", common_clock("clock", every(0ms), within(200us))), row),
              "lane: common_clock(\"clock\") is sent every 0 ms; write every(...) from 10 ms to 10 s");
    EXPECT_EQ(refusal(pair::usual_wire("wire", common_clock("clock", every(10ms), within(200us))), row),
              "lane: common_clock(\"clock\") is sent every 10 ms, of which a quarter must do for a frame and "
              "served_within(...) twice; write every(...) of 16 ms at least, or serve the wire sooner");
    EXPECT_EQ(refusal(pair::usual_wire("wire", common_clock("clock", every(100ms), within(200us)),
                                       common_clock("a", every(100ms), within(200us))),
                      row),
              "lane: wire \"wire\" has 2 common_clock(...); one node sends the time, remove the others");
    EXPECT_EQ(refusal(pair::usual_wire("wire",
                                       common_clock("clock", every(100ms), within(200us), stamps_late(0us))),
                      row),
              "lane: common_clock(\"clock\"): stamps_late(...) must be above 0 and drift(...) from 0 to "
              "1e-2; correct them");
    EXPECT_EQ(refusal(pair::usual_wire("wire", identifiers_from(0x200), fixed_identifiers), row),
              "lane: wire \"wire\" has both identifiers_from(...) and fixed_identifiers; remove one of them");
    EXPECT_EQ(refusal(pair::usual_wire("wire", common_clock("clock", every(100ms))), row),
              "lane: common_clock(\"clock\") has no permitted error; add within(200us)");
    EXPECT_EQ(refusal(pair::usual_wire("wire", common_clock("clock", every(100ms), within(50us))), row),
              "lane: common_clock(\"clock\"): its error may be 124 us, but it is promised within 50 us; the "
              "larger part, 100 us, is how late frames are stamped; write a shorter stamps_late(...) if that "
              "is true, or promise less");
    EXPECT_EQ(
        refusal(pair::usual_wire("wire", common_clock("clock", every(1s), within(150us), stamps_late(10us))),
                row),
        "lane: common_clock(\"clock\"): its error may be 241 us, but it is promised within 150 us; the "
        "larger part, 231 us, is the drift of the clocks in 1007 ms; send it more often, or promise less");
    Crossing long_lived = row;
    long_lived.data.max_age = 2s;
    EXPECT_EQ(refusal(clocked_wire, long_lived),
              "lane: crossing \"a.speaker.told_at\" -> \"b.listener.told_at\" is sent with_time, which holds "
              "for 381 ms; write stale_after(...) of at most that");
}

} // namespace
} // namespace tappet::time_test

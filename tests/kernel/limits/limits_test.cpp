// Limits of what a component writes: what goes out, what is counted, what stops the machine, and which rows
// are refused.
#include "kernel/limits/limits.hpp"

#include "kernel/machine/accept.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tappet {
namespace {

using testing::HasSubstr;

/// Writes what the test wants, each millisecond.
struct Source {
    double speed_wanted = 0.0;
    bool writes_at_start = false;
    std::int32_t place_wanted = 0;
    Output<double> speed;
    Output<std::int32_t> place;
    Output<std::int64_t> turns;
    Output<bool> on;
    BufferOutput<double> samples;
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        if (writes_at_start) speed.write(speed_wanted);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        speed.write(speed_wanted);
        place.write(place_wanted);
    }
    double speed_left = 0.0;
    void stop(const Cycle&) noexcept TAPPET_REALTIME { speed.write(speed_left); }
    static constexpr auto interface() {
        return facets(output<&Source::speed>("speed", "rpm", "of the drive"),
                      output<&Source::place>("place", "mm", "of the ram"),
                      output<&Source::turns>("turns", "", "since the start"),
                      output<&Source::on>("on", "", "whether it is"),
                      output<&Source::samples>("samples", "", "raw"));
    }
};

/// What reaches another activity.
struct Sink {
    double speed_seen = 0.0;
    std::int32_t place_seen = 0;
    Input<double> speed;
    Input<std::int32_t> place;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        speed_seen = speed.get();
        place_seen = place.get();
    }
    static constexpr auto interface() {
        return facets(input<&Sink::speed>("speed", "rpm", "commanded"),
                      input<&Sink::place>("place", "mm", "commanded"));
    }
};

constexpr Board box{.name = "box", .memory_budget_bytes = 1 << 20};

template <class... Extra>
constexpr auto machine_with(const Extra&... extra) {
    return machine("press", components(component<Source>("source"), component<Sink>("sink")),
                   activities(activity("motion", every(1ms), budget(50us), runs("source")),
                              activity("wire", every(2ms), budget(50us), runs("sink"))),
                   connections(data("source.speed", "sink.speed"), data("source.place", "sink.place")),
                   reactions(), behaviours(), extra...);
}

template <const auto& table>
struct Rig {
    os::Clock clock{os::Clock::Kind::virtual_time};
    Accepted accepted{table.view(), box};
    MachineInstance instance{accepted.machine(), clock};
    VirtualWorld world{instance};
    Source* source = nullptr;
    Sink* sink = nullptr;

    Rig() {
        EXPECT_TRUE(instance.configure({}));
        source = instance.template find<Source>("source");
        sink = instance.template find<Sink>("sink");
    }
    bool run(Duration time) { return world.run_until(clock.now() + time); }
    [[nodiscard]] std::uint64_t breaches(std::size_t row) const {
        return instance.observation().counted(0, row).times;
    }
};

// ---- what goes out

constexpr auto clamped =
    machine_with(limits(limit("source.speed", -10.0, 40.0), rate("source.place", 500.0)));

TEST(Limits, let_out_what_they_allow_and_count_nothing) {
    Rig<clamped> rig;
    rig.source->speed_wanted = 40.0;
    EXPECT_TRUE(rig.world.start().empty());
    EXPECT_TRUE(rig.run(10ms));
    EXPECT_EQ(rig.sink->speed_seen, 40.0);
    EXPECT_EQ(rig.breaches(0), 0u);
}

TEST(Limits, let_out_the_nearest_value_and_count_each_that_they_held_back) {
    Rig<clamped> rig;
    EXPECT_TRUE(rig.world.start().empty());
    for (const auto& [wanted, seen] : {std::pair{41.0, 40.0}, {-11.0, -10.0}, {7.0, 7.0}}) {
        rig.source->speed_wanted = wanted;
        EXPECT_TRUE(rig.run(10ms));
        EXPECT_EQ(rig.sink->speed_seen, seen);
        EXPECT_EQ(rig.source->speed.last(), seen) << "the component sees what went out";
    }
    EXPECT_EQ(rig.breaches(0), 20u);
}

TEST(Limits, hold_the_last_value_in_place_of_what_is_no_number) {
    Rig<clamped> rig;
    EXPECT_TRUE(rig.world.start().empty());
    rig.source->speed_wanted = 12.0;
    EXPECT_TRUE(rig.run(5ms));
    rig.source->speed_wanted = std::nan("");
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_EQ(rig.sink->speed_seen, 12.0);
    EXPECT_EQ(rig.breaches(0), 5u);
}

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr auto half_open = machine_with(limits(limit("source.speed", -infinite, 40.0)));
constexpr auto open_rate = machine_with(limits(rate("source.speed", 500.0)));
constexpr auto counted_only = machine_with(limits(limit("source.speed", -10.0, 40.0, count_on_breach)));

template <const auto& table>
void expect_numbers_only(double later) {
    for (const double first : {std::nan(""), infinite, -infinite, 1.0}) {
        Rig<table> rig;
        rig.source->speed_wanted = first;
        EXPECT_TRUE(rig.world.start().empty());
        for (const double wanted : {first, infinite, std::nan(""), -infinite}) {
            rig.source->speed_wanted = wanted;
            EXPECT_TRUE(rig.run(4ms));
            EXPECT_TRUE(std::isfinite(rig.sink->speed_seen)) << first << " then " << wanted;
        }
        rig.source->speed_wanted = later;
        EXPECT_TRUE(rig.run(10s));
        EXPECT_EQ(rig.sink->speed_seen, later) << first;
    }
}

TEST(Limits, let_nothing_out_that_is_no_number_whichever_ends_they_have) {
    expect_numbers_only<clamped>(10.0);
    expect_numbers_only<half_open>(10.0);
    expect_numbers_only<open_rate>(10.0);
    expect_numbers_only<counted_only>(10.0);
}

TEST(Limits, hold_for_what_a_start_writes) {
    Rig<clamped> rig;
    rig.source->writes_at_start = true;
    rig.source->speed_wanted = 999.0;
    EXPECT_TRUE(rig.world.start().empty());
    EXPECT_EQ(rig.source->speed.last(), 40.0);
    EXPECT_EQ(rig.breaches(0), 1u);
}

TEST(Limits, of_a_rate_lead_a_whole_number_to_its_end_by_and_by) {
    Rig<clamped> rig;
    EXPECT_TRUE(rig.world.start().empty());
    EXPECT_TRUE(rig.run(4ms)); // it stands at 0
    rig.source->place_wanted = 100;
    EXPECT_TRUE(rig.run(101ms)); // 500 mm/s: half a millimetre in each cycle
    EXPECT_NEAR(rig.sink->place_seen, 50, 2);
    EXPECT_TRUE(rig.run(200ms));
    EXPECT_EQ(rig.sink->place_seen, 100);
    const std::uint64_t on_the_way = rig.breaches(1);
    EXPECT_NEAR(static_cast<double>(on_the_way), 199.0, 2.0);
    EXPECT_TRUE(rig.run(50ms));
    EXPECT_EQ(rig.breaches(1), on_the_way) << "it is there";
}

TEST(Limits, of_a_rate_let_the_first_value_after_a_start_be_any) {
    Rig<clamped> rig;
    rig.source->place_wanted = 70;
    EXPECT_TRUE(rig.world.start().empty());
    EXPECT_TRUE(rig.run(4ms));
    EXPECT_EQ(rig.sink->place_seen, 70);
    EXPECT_EQ(rig.breaches(1), 0u);
}

constexpr auto never_at_rest =
    machine_with(limits(limit("source.speed", 5.0, 40.0), rate("source.speed", 100.0)));

TEST(Limits, do_not_hold_back_the_safe_value_of_a_stop) {
    Rig<never_at_rest> rig;
    rig.source->speed_wanted = 40.0;
    EXPECT_TRUE(rig.world.start().empty());
    EXPECT_TRUE(rig.run(10ms));
    EXPECT_EQ(rig.sink->speed_seen, 40.0);
    rig.instance.life().ask_component(find_component(rig.instance.machine().table, "source"),
                                      LifeChange::stop);
    EXPECT_TRUE(rig.run(10ms));
    EXPECT_EQ(rig.sink->speed_seen, 0.0);
    EXPECT_EQ(rig.breaches(0) + rig.breaches(1), 0u);
}

TEST(Limits, let_no_safe_value_out_that_is_no_number) {
    for (const double left : {std::nan(""), infinite, -infinite}) {
        Rig<clamped> rig;
        rig.source->speed_wanted = 20.0;
        rig.source->speed_left = left;
        EXPECT_TRUE(rig.world.start().empty());
        EXPECT_TRUE(rig.run(10ms));
        rig.instance.life().ask_component(find_component(rig.instance.machine().table, "source"),
                                          LifeChange::stop);
        EXPECT_TRUE(rig.run(10ms));
        EXPECT_EQ(rig.sink->speed_seen, 0.0);
        EXPECT_EQ(rig.breaches(0), 1u);
    }
}

TEST(Limits, of_range_and_rate_hold_both_for_one_port) {
    Rig<never_at_rest> rig;
    rig.source->speed_wanted = 10.0;
    EXPECT_TRUE(rig.world.start().empty());
    EXPECT_TRUE(rig.run(10ms));
    rig.source->speed_wanted = 90.0; // to 40 at 0.1 for each millisecond
    EXPECT_TRUE(rig.run(100ms));
    EXPECT_NEAR(rig.sink->speed_seen, 20.0, 0.3);
    EXPECT_TRUE(rig.run(300ms));
    EXPECT_EQ(rig.sink->speed_seen, 40.0);
    EXPECT_EQ(rig.breaches(0), 400u) << "90 is never in range";
    EXPECT_NEAR(static_cast<double>(rig.breaches(1)), 299.0, 2.0);
}

// ---- what else a breach does

constexpr auto counted = machine_with(limits(limit("source.speed", 0.0, 40.0, count_on_breach)));

TEST(Limits, that_only_count_change_nothing) {
    Rig<counted> rig;
    rig.source->speed_wanted = 90.0;
    EXPECT_TRUE(rig.world.start().empty());
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_EQ(rig.sink->speed_seen, 90.0);
    EXPECT_EQ(rig.instance.observation().counted(0, 0).what, "source.speed");
    EXPECT_EQ(rig.breaches(0), 5u);
    EXPECT_EQ(rig.instance.observation().counted(0, 1).what, "") << "there is no second row";
    EXPECT_EQ(rig.instance.observation().counted(1, 0).what, "") << "nor a second section";
}

constexpr auto stopping = machine_with(
    limits(limit("source.speed", 0.0, 40.0, stop_on_breach), rate("source.place", 10.0, stop_on_breach)));

TEST(Limits, that_stop_the_machine_say_which_row_and_let_nothing_out) {
    Rig<stopping> rig;
    EXPECT_TRUE(rig.world.start().empty());
    EXPECT_TRUE(rig.run(5ms));
    rig.source->speed_wanted = 41.0;
    EXPECT_FALSE(rig.run(5ms));
    EXPECT_EQ(rig.source->speed.last(), 40.0);
    EXPECT_EQ(rig.instance.stop_request().reason, StopReason::section);
    EXPECT_EQ(rig.instance.describe_stop().view(), "\"source.speed\" was to leave its range from 0 to 40");
}

TEST(Limits, that_stop_the_machine_say_so_of_a_rate) {
    Rig<stopping> rig;
    EXPECT_TRUE(rig.world.start().empty());
    EXPECT_TRUE(rig.run(5ms));
    rig.source->place_wanted = 9;
    EXPECT_FALSE(rig.run(5ms));
    EXPECT_EQ(rig.instance.describe_stop().view(),
              "\"source.place\" was to change by more than 10 per second");
}

// ---- what is forced

TEST(Limits, leave_a_forced_value_alone_and_hold_again_after_it) {
    Rig<clamped> rig;
    EXPECT_TRUE(rig.world.start().empty());
    rig.source->speed_wanted = 90.0;
    EXPECT_TRUE(rig.run(5ms));
    const AcceptedMachine& accepted = rig.instance.machine();
    End speed;
    ASSERT_TRUE(resolve(accepted.table, "source.speed", FacetKind::output, speed).empty());
    const PortOperations& port = *facet_at(accepted.table, speed).port;
    const double forced = 60.0;
    port.force(rig.instance.place_of(speed), false, reinterpret_cast<const std::byte*>(&forced));
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_EQ(rig.sink->speed_seen, 60.0);
    port.release(rig.instance.place_of(speed), false);
    EXPECT_TRUE(rig.run(5ms));
    EXPECT_EQ(rig.sink->speed_seen, 40.0);
}

// ---- refused rows

constexpr auto misspelt = machine_with(limits(limit("source.sped", 0.0, 1.0)));
constexpr auto input = machine_with(limits(rate("sink.speed", 1.0)));
constexpr auto too_wide = machine_with(limits(limit("source.turns", 0.0, 1.0)));
constexpr auto truth = machine_with(limits(limit("source.on", 0.0, 1.0)));
constexpr auto buffer = machine_with(limits(limit("source.samples", 0.0, 1.0)));
constexpr auto reversed = machine_with(limits(limit("source.speed", 1.0, 0.0)));
constexpr auto no_number =
    machine_with(limits(limit("source.speed", std::numeric_limits<double>::quiet_NaN(), 1.0)));
constexpr auto at_rest = machine_with(limits(rate("source.speed", 0.0)));
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr auto endless = machine_with(limits(rate("source.speed", infinity)));
constexpr auto everything = machine_with(limits(limit("source.speed", -infinity, infinity)));
constexpr auto fraction = machine_with(limits(limit("source.place", 0.5, 3.0)));
constexpr auto beyond = machine_with(limits(limit("source.place", 0.0, 2147483648.0)));
constexpr auto one_end = machine_with(limits(limit("source.place", -2147483648.0, infinity)));
constexpr auto twice = machine_with(
    limits(limit("source.speed", 0.0, 1.0), rate("source.speed", 1.0), limit("source.speed", 0.0, 2.0)));

template <const auto& table>
std::string refusal() {
    return std::string{Accepted{table.view(), box}.refusal().view()};
}

TEST(LimitRows, are_refused_with_row_fault_and_cure) {
    EXPECT_EQ(refusal<clamped>(), "");
    EXPECT_EQ(refusal<misspelt>(),
              "press: limit \"source.sped\": component \"source\" has no output \"sped\"; did "
              "you mean \"speed\"?");
    EXPECT_EQ(refusal<input>(), "press: rate \"sink.speed\": an input has no limits; name an output");
    EXPECT_THAT(refusal<too_wide>(), HasSubstr("only numbers that a double holds are limited"));
    EXPECT_THAT(refusal<truth>(), HasSubstr("only numbers that a double holds are limited"));
    EXPECT_THAT(refusal<buffer>(), HasSubstr("a buffered output has no limits; name an output"));
    EXPECT_THAT(refusal<reversed>(),
                HasSubstr("its least value is not below its greatest; write the smaller"));
    EXPECT_THAT(refusal<no_number>(), HasSubstr("its least value is not below its greatest"));
    EXPECT_THAT(refusal<at_rest>(), HasSubstr("its rate is not above zero or has no end"));
    EXPECT_THAT(refusal<endless>(), HasSubstr("its rate is not above zero or has no end"));
    EXPECT_THAT(refusal<everything>(), HasSubstr("it allows everything; give it an end, or leave it out"));
    EXPECT_THAT(refusal<fraction>(), HasSubstr("an end of it is no value of int;"));
    EXPECT_THAT(refusal<beyond>(), HasSubstr("an end of it is no value of int;"));
    EXPECT_EQ(refusal<one_end>(), "");
    EXPECT_EQ(refusal<twice>(), "press: limit \"source.speed\": it stands twice; keep one");
}

/// Writes far jumps, which claim to be true a second later, all but the first.
struct Hasty {
    Output<double> speed;
    Duration ahead{};
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        speed.write(speed.last() + 1e6, cycle.now + ahead);
        ahead = 1s;
    }
    static constexpr auto interface() {
        return facets(output<&Hasty::speed>("speed", "rpm", "of the drive"));
    }
};
constexpr auto hasty = machine("hasty", components(component<Hasty>("source")),
                               activities(activity("motion", every(1ms), budget(50us), runs("source"))),
                               connections(), reactions(), behaviours(), limits(rate("source.speed", 500.0)));

TEST(Rate, is_that_of_the_machines_time_whatever_time_a_value_claims) {
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{AtRunTime<hasty, box>::machine(), clock};
    VirtualWorld world{instance};
    ASSERT_TRUE(instance.configure({}));
    ASSERT_TRUE(world.start().empty());
    const Output<double>& speed = instance.find<Hasty>("source")->speed;
    ASSERT_TRUE(world.run_until(clock.now() + 1ms));
    const double first = speed.last();
    ASSERT_TRUE(world.run_until(clock.now() + 1s));
    EXPECT_LE(speed.last() - first, 500.0 * 1.001);
}

} // namespace
} // namespace tappet

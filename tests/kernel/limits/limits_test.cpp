// Limits of written values: outputs, counts, stops of the machine, and refused rows.
#include "kernel/limits/limits.hpp"

#include "tests/kernel/machine/virtual_rig.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

namespace tappet {
namespace {

using testing::HasSubstr;

/// Writes the test's value each millisecond.
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

/// The receiver in another activity.
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

template <class... Extra>
constexpr auto machine_with(const Extra&... extra) {
    return machine("press", components(component<Source>("source"), component<Sink>("sink")),
                   activities(activity("motion", every(1ms), budget(50us), runs("source")),
                              activity("wire", every(2ms), budget(50us), runs("sink"))),
                   connections(data("source.speed", "sink.speed"), data("source.place", "sink.place")),
                   reactions(), behaviours(), extra...);
}

template <const auto& table>
struct Rig : VirtualRig {
    explicit Rig(const std::function<void(Source&)>& before_start = [](Source&) {})
        : VirtualRig{AtRunTime<table, test_board>::machine()} {
        start([&] { before_start(source); });
    }
    /// Wants the speed for so long and returns the speed received.
    double seen(double speed, Duration time) {
        source.speed_wanted = speed;
        EXPECT_TRUE(run(time));
        return sink.speed_seen;
    }
    [[nodiscard]] std::uint64_t breaches(std::size_t row) const {
        return instance.observation().counted(0, row).times;
    }
    Source& source = *instance.find<Source>("source");
    Sink& sink = *instance.find<Sink>("sink");
};

// ---- outputs

constexpr auto clamped =
    machine_with(limits(limit("source.speed", -10.0, 40.0), rate("source.place", 500.0)));

TEST(Limits, pass_allowed_values_and_count_nothing) {
    Rig<clamped> rig;
    EXPECT_EQ(rig.seen(40.0, 10ms), 40.0);
    EXPECT_EQ(rig.breaches(0), 0u);
}

TEST(Limits, clamp_to_the_nearest_bound_and_count_each_clamped_value) {
    Rig<clamped> rig;
    for (const auto& [wanted, seen] : {std::pair{41.0, 40.0}, {-11.0, -10.0}, {7.0, 7.0}}) {
        EXPECT_EQ(rig.seen(wanted, 10ms), seen);
        EXPECT_EQ(rig.source.speed.last(), seen) << "the component sees what went out";
    }
    EXPECT_EQ(rig.breaches(0), 20u);
}

TEST(Limits, hold_the_last_value_instead_of_a_value_that_is_not_a_number) {
    Rig<clamped> rig;
    EXPECT_EQ(rig.seen(12.0, 5ms), 12.0);
    EXPECT_EQ(rig.seen(std::nan(""), 5ms), 12.0);
    EXPECT_EQ(rig.breaches(0), 5u);
}

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr auto half_open = machine_with(limits(limit("source.speed", -infinite, 40.0)));
constexpr auto open_rate = machine_with(limits(rate("source.speed", 500.0)));
constexpr auto counted_only = machine_with(limits(limit("source.speed", -10.0, 40.0, count_on_breach)));

template <const auto& table>
void expect_numbers_only(double later) {
    for (const double first : {std::nan(""), infinite, -infinite, 1.0}) {
        Rig<table> rig{[first](Source& source) { source.speed_wanted = first; }};
        for (const double wanted : {first, infinite, std::nan(""), -infinite})
            EXPECT_TRUE(std::isfinite(rig.seen(wanted, 4ms))) << first << " then " << wanted;
        EXPECT_EQ(rig.seen(later, 10s), later) << first;
    }
}

TEST(Limits, never_pass_a_value_that_is_not_a_number) {
    expect_numbers_only<clamped>(10.0);
    expect_numbers_only<half_open>(10.0);
    expect_numbers_only<open_rate>(10.0);
    expect_numbers_only<counted_only>(10.0);
}

TEST(Limits, apply_to_values_written_at_start) {
    Rig<clamped> rig{[](Source& source) {
        source.writes_at_start = true;
        source.speed_wanted = 999.0;
    }};
    EXPECT_EQ(rig.source.speed.last(), 40.0);
    EXPECT_EQ(rig.breaches(0), 1u);
}

TEST(Limits, of_a_rate_lead_an_integer_gradually_to_its_target) {
    Rig<clamped> rig;
    EXPECT_TRUE(rig.run(4ms)); // it is at 0
    rig.source.place_wanted = 100;
    EXPECT_TRUE(rig.run(101ms)); // 500 mm/s: half a millimetre in each cycle
    EXPECT_NEAR(rig.sink.place_seen, 50, 2);
    EXPECT_TRUE(rig.run(200ms));
    EXPECT_EQ(rig.sink.place_seen, 100);
    const std::uint64_t on_the_way = rig.breaches(1);
    EXPECT_NEAR(static_cast<double>(on_the_way), 199.0, 2.0);
    EXPECT_TRUE(rig.run(50ms));
    EXPECT_EQ(rig.breaches(1), on_the_way) << "it is there";
}

TEST(Limits, of_a_rate_allow_any_first_value_after_a_start) {
    Rig<clamped> rig{[](Source& source) { source.place_wanted = 70; }};
    EXPECT_TRUE(rig.run(4ms));
    EXPECT_EQ(rig.sink.place_seen, 70);
    EXPECT_EQ(rig.breaches(1), 0u);
}

constexpr auto never_at_rest =
    machine_with(limits(limit("source.speed", 5.0, 40.0), rate("source.speed", 100.0)));

TEST(Limits, pass_the_safe_value_of_a_stop) {
    Rig<never_at_rest> rig{[](Source& source) { source.speed_wanted = 40.0; }};
    EXPECT_EQ(rig.seen(40.0, 10ms), 40.0);
    rig.change("source", LifeChange::stop);
    EXPECT_TRUE(rig.run(10ms));
    EXPECT_EQ(rig.sink.speed_seen, 0.0);
    EXPECT_EQ(rig.breaches(0) + rig.breaches(1), 0u);
}

TEST(Limits, block_a_safe_value_that_is_not_a_number) {
    for (const double left : {std::nan(""), infinite, -infinite}) {
        Rig<clamped> rig;
        rig.source.speed_left = left;
        EXPECT_EQ(rig.seen(20.0, 10ms), 20.0);
        rig.change("source", LifeChange::stop);
        EXPECT_EQ(rig.seen(20.0, 10ms), 0.0);
        EXPECT_EQ(rig.breaches(0), 1u);
    }
}

TEST(Limits, apply_range_and_rate_to_one_port_together) {
    Rig<never_at_rest> rig{[](Source& source) { source.speed_wanted = 10.0; }};
    EXPECT_EQ(rig.seen(10.0, 10ms), 10.0);
    EXPECT_NEAR(rig.seen(90.0, 100ms), 20.0, 0.3) << "to 40 at 0.1 for each millisecond";
    EXPECT_EQ(rig.seen(90.0, 300ms), 40.0);
    EXPECT_EQ(rig.breaches(0), 400u) << "90 is never in range";
    EXPECT_NEAR(static_cast<double>(rig.breaches(1)), 299.0, 2.0);
}

// ---- other effects of a breach

constexpr auto counted = machine_with(limits(limit("source.speed", 0.0, 40.0, count_on_breach)));

TEST(Limits, change_nothing_when_their_row_only_counts) {
    Rig<counted> rig;
    EXPECT_EQ(rig.seen(90.0, 5ms), 90.0);
    EXPECT_EQ(rig.instance.observation().counted(0, 0).what, "source.speed");
    EXPECT_EQ(rig.breaches(0), 5u);
    EXPECT_EQ(rig.instance.observation().counted(0, 1).what, "") << "there is no second row";
    EXPECT_EQ(rig.instance.observation().counted(1, 0).what, "") << "nor a second section";
}

constexpr auto stopping = machine_with(
    limits(limit("source.speed", 0.0, 40.0, stop_on_breach), rate("source.place", 10.0, stop_on_breach)));

TEST(Limits, name_the_row_and_pass_nothing_when_they_stop_the_machine) {
    Rig<stopping> rig;
    EXPECT_TRUE(rig.run(5ms));
    rig.source.speed_wanted = 41.0;
    EXPECT_FALSE(rig.run(5ms));
    EXPECT_EQ(rig.source.speed.last(), 40.0);
    EXPECT_EQ(rig.instance.stop_request().reason, StopReason::section);
    EXPECT_EQ(rig.instance.describe_stop().view(), "\"source.speed\" would have left its range from 0 to 40");
}

TEST(Limits, report_a_rate_when_they_stop_the_machine) {
    Rig<stopping> rig;
    EXPECT_TRUE(rig.run(5ms));
    rig.source.place_wanted = 9;
    EXPECT_FALSE(rig.run(5ms));
    EXPECT_EQ(rig.instance.describe_stop().view(),
              "\"source.place\" would have changed by more than 10 per second");
}

// ---- forced values

TEST(Limits, ignore_a_forced_value_and_apply_again_after_it) {
    Rig<clamped> rig;
    EXPECT_EQ(rig.seen(90.0, 5ms), 40.0);
    const AcceptedMachine& accepted = rig.instance.machine();
    End speed;
    ASSERT_TRUE(resolve(accepted.table, "source.speed", FacetKind::output, speed).empty());
    const PortOperations& port = *facet_at(accepted.table, speed).port;
    const double forced = 60.0;
    port.force(rig.instance.place_of(speed), false, reinterpret_cast<const std::byte*>(&forced));
    EXPECT_EQ(rig.seen(90.0, 5ms), 60.0);
    port.release(rig.instance.place_of(speed), false);
    EXPECT_EQ(rig.seen(90.0, 5ms), 40.0);
}

// ---- refused rows

template <class... Rows>
std::string refusal(const Rows&... rows) {
    const auto table = machine_with(limits(rows...));
    return std::string{Accepted{table.view(), test_board}.refusal().view()};
}

TEST(LimitRows, are_refused_with_the_row_the_fault_and_the_cure) {
    EXPECT_EQ(refusal(limit("source.speed", -10.0, 40.0), rate("source.place", 500.0)), "");
    EXPECT_EQ(refusal(limit("source.sped", 0.0, 1.0)),
              "press: limit \"source.sped\": component \"source\" has no output \"sped\"; did "
              "you mean \"speed\"?");
    EXPECT_EQ(refusal(rate("sink.speed", 1.0)),
              "press: rate \"sink.speed\": an input has no limits; name an output");
    for (const char* output : {"source.turns", "source.on"})
        EXPECT_THAT(refusal(limit(output, 0.0, 1.0)),
                    HasSubstr("cannot be limited, only numbers that a double holds"));
    EXPECT_THAT(refusal(limit("source.samples", 0.0, 1.0)),
                HasSubstr("a buffered output has no limits; name an output"));
    EXPECT_THAT(refusal(limit("source.speed", 1.0, 0.0)),
                HasSubstr("its least value is not below its greatest; write the smaller"));
    EXPECT_THAT(refusal(limit("source.speed", std::nan(""), 1.0)),
                HasSubstr("its least value is not below its greatest"));
    for (const double none : {0.0, infinite})
        EXPECT_THAT(refusal(rate("source.speed", none)),
                    HasSubstr("its rate is not a finite number above 0"));
    EXPECT_THAT(refusal(limit("source.speed", -infinite, infinite)),
                HasSubstr("it limits nothing; give it a bound, or leave it out"));
    EXPECT_THAT(refusal(limit("source.place", 0.5, 3.0)),
                HasSubstr("one of its bounds is not a value of int;"));
    EXPECT_THAT(refusal(limit("source.place", 0.0, 2147483648.0)),
                HasSubstr("one of its bounds is not a value of int;"));
    EXPECT_EQ(refusal(limit("source.place", -2147483648.0, infinite)), "");
    EXPECT_EQ(
        refusal(limit("source.speed", 0.0, 1.0), rate("source.speed", 1.0), limit("source.speed", 0.0, 2.0)),
        "press: limit \"source.speed\": it appears twice; keep one");
}

/// Writes large jumps; all but the first carry a stamp one second ahead.
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

TEST(Rate, uses_machine_time_whatever_stamp_a_value_has) {
    VirtualRig rig{AtRunTime<hasty, test_board>::machine()};
    rig.start();
    const Output<double>& speed = rig.the<Hasty>("source").speed;
    ASSERT_TRUE(rig.run(1ms));
    const double first = speed.last();
    ASSERT_TRUE(rig.run(1s));
    EXPECT_LE(speed.last() - first, 500.0 * 1.001);
}

} // namespace
} // namespace tappet

// Forced ports (thesis 4.8: a browser changes what a task reads and writes): what is forced is what flows,
// whatever the component does, and releasing leaves no trace.
#include "tests/kernel/component/port_rig.hpp"

namespace {

using namespace tappet;

struct Forcing : PortsOfEachTopology {
    void force_output(double to) { port.force(&output, false, reinterpret_cast<const std::byte*>(&to)); }
    void force_input(double to) { port.force(&input, true, reinterpret_cast<const std::byte*>(&to)); }
    template <class T> static T at(const void* place) { return *static_cast<const T*>(place); }
};

INSTANTIATE_TEST_SUITE_P(, Forcing, testing::Bool(), topology);

TEST_P(Forcing, an_output_publishes_the_forced_value_at_once_and_whatever_its_component_writes) {
    output.write(1.0);
    force_output(9.0);
    EXPECT_EQ(read(), (Read{Flow::fresh, 9.0}));
    output.write(2.0);
    EXPECT_EQ(read(), (Read{Flow::fresh, 9.0})) << "each write stays a sign of life";
    EXPECT_EQ(output.last(), 2.0) << "what the component knows of its own is what it wrote";
}

TEST_P(Forcing, releasing_an_output_publishes_what_its_component_wrote_last) {
    output.write(1.0);
    force_output(9.0);
    port.release(&output, false);
    EXPECT_EQ(input.get(), 1.0) << "written before";
    force_output(9.0);
    output.write(2.0);
    force_output(8.0);
    EXPECT_EQ(input.get(), 8.0) << "forced again, to another value";
    port.release(&output, false);
    EXPECT_EQ(input.get(), 2.0) << "written meanwhile";
    output.write(3.0);
    EXPECT_EQ(input.get(), 3.0);
}

TEST_P(Forcing, an_output_that_its_component_never_wrote_is_not_forced) {
    const double to = 9.0;
    EXPECT_FALSE(port.force(&output, false, reinterpret_cast<const std::byte*>(&to)));
    EXPECT_EQ(input.read(value), Flow::never_written);
    port.release(&output, false);
    EXPECT_EQ(input.read(value), Flow::never_written);
}

TEST_P(Forcing, releasing_an_output_makes_no_old_value_new) {
    port.set_policy(&input, {.max_age = 4ms});
    output.write(1.0);
    now += 1h;
    force_output(9.0);
    EXPECT_EQ(input.read(value), Flow::fresh);
    port.release(&output, false);
    EXPECT_EQ(input.read(value), Flow::stale) << "written before";
    EXPECT_EQ(input.stamp(), at_ns(0));
    force_output(9.0);
    output.write(2.0);
    now += 2ms;
    port.release(&output, false);
    EXPECT_EQ(read(), (Read{Flow::fresh, 2.0})) << "written meanwhile";
    now += 3ms;
    EXPECT_EQ(input.read(value), Flow::stale);
}

TEST_P(Forcing, an_input_reads_the_forced_value_fresh_once_and_never_stale) {
    port.set_policy(
        &input,
        {.max_age = 4ms, .when_stale = WhenStale::substitute, .substitute = {.given = true, .number = -5}});
    output.write(1.0);
    EXPECT_EQ(input.get(), 1.0);
    force_input(9.0);
    EXPECT_EQ(read(), (Read{Flow::fresh, 9.0}));
    output.write(2.0);
    EXPECT_EQ(read(), (Read{Flow::old, 9.0}));
    now += 1h;
    EXPECT_EQ(read(), (Read{Flow::old, 9.0}));
}

TEST_P(Forcing, an_input_lets_go_when_its_writer_has_left_its_safe_value) {
    std::atomic<std::uint32_t> forced{1};
    Stops writer;
    writer.forced = &forced;
    link(&writer);
    writer.count = 3; // before it was forced
    output.write(1.0);
    force_input(9.0);
    EXPECT_EQ(input.get(), 9.0);
    port.begin_life(&output, life_after(writer.count));
    output.write(0.0);
    EXPECT_EQ(input.get(), 9.0);
    writer.count += Stops::of_a_life;
    EXPECT_EQ(read(), (Read{Flow::fresh, 0.0}));
    EXPECT_EQ(forced, 0u);
    force_input(9.0);
    EXPECT_EQ(input.get(), 9.0) << "forced after that";
}

TEST_P(Forcing, an_input_that_nobody_ever_wrote_can_be_forced) {
    force_input(9.0);
    EXPECT_EQ(read(), (Read{Flow::fresh, 9.0}));
    port.release(&input, true);
    EXPECT_EQ(read(), (Read{Flow::never_written, 0.0}));
}

TEST_P(Forcing, releasing_an_input_reads_again_what_stands_at_the_other_end) {
    output.write(1.0);
    EXPECT_EQ(input.get(), 1.0);
    force_input(9.0);
    EXPECT_EQ(input.get(), 9.0);
    port.release(&input, true);
    EXPECT_EQ(read(), (Read{Flow::fresh, 1.0})) << "although nothing was written meanwhile";
}

TEST_P(Forcing, releasing_what_is_not_forced_changes_nothing) {
    output.write(1.0);
    EXPECT_EQ(input.get(), 1.0);
    port.release(&input, true);
    port.release(&output, false);
    EXPECT_EQ(read(), (Read{Flow::old, 1.0}));
}

TEST_P(Forcing, an_observer_finds_value_time_and_flag) {
    now = at_ns(700);
    output.write(1.0);
    static_cast<void>(input.get());
    for (const bool is_input : {false, true}) {
        const void* of = is_input ? static_cast<const void*>(&input) : &output;
        const PortPlaces places = port.places(of, is_input);
        EXPECT_EQ(at<double>(places.value), 1.0);
        EXPECT_EQ(*places.stamp, at_ns(700));
        EXPECT_EQ(*places.writes, 1u);
        EXPECT_FALSE(*places.forced);
    }
    force_output(9.0);
    force_input(8.0);
    EXPECT_TRUE(*port.places(&output, false).forced);
    EXPECT_EQ(at<double>(port.places(&output, false).value), 9.0);
    EXPECT_TRUE(*port.places(&input, true).forced);
    EXPECT_EQ(at<double>(port.places(&input, true).forced_value), 8.0);
}

/// The writer of what is forced, and its reader, as engines stop and start them.
struct AbandonedValue : Forcing {
    Stops writer;
    AbandonedValue() {
        link(&writer);
        now = at_ns(0) + 1s;
        output.write(1.0);
        force_input(9.0);
    }
    void begin_stop() {
        now += 1s;
        port.begin_life(&output, life_after(writer.count));
    }
    void end_stop() {
        port.end_force(&output, false);
        writer.count += Stops::of_a_life;
    }
    void stop() {
        begin_stop();
        end_stop();
    }
    void restart_reader() {
        port.end_force(&input, true);
        expect_abandoned();
        port.resume(&input);
    }
    void expect(double wanted) {
        EXPECT_EQ(input.get(), wanted);
        EXPECT_TRUE(input.good());
        EXPECT_FALSE(input.is_abandoned());
        EXPECT_GT(input.stamp(), before_all);
    }
    void expect_abandoned() {
        static_cast<void>(input.read(value));
        EXPECT_TRUE(input.is_abandoned());
        EXPECT_EQ(port.read(&input, true, true, reinterpret_cast<std::byte*>(&value)), Flow::stale);
        EXPECT_EQ(input.stamp(), before_all);
    }
};

INSTANTIATE_TEST_SUITE_P(, AbandonedValue, testing::Bool(), topology);

TEST_P(AbandonedValue, is_what_a_force_hid_when_it_ended_with_a_stop) {
    stop();
    expect_abandoned();
    output.write(2.0);
    expect(2.0);
}

TEST_P(AbandonedValue, is_none_that_a_stop_left_whatever_its_time) {
    begin_stop();
    output.write(0.5, at_ns(0));
    end_stop();
    expect(0.5);
}

TEST_P(AbandonedValue, is_none_that_is_written_after_a_stop_before_anybody_looks) {
    stop();
    output.write(3.0, at_ns(0));
    expect(3.0);
}

TEST_P(AbandonedValue, is_none_that_a_stop_left_when_a_second_one_comes_before_anybody_looks) {
    begin_stop();
    output.write(0.5);
    end_stop();
    stop();
    expect(0.5);
}

TEST_P(AbandonedValue, is_one_whose_time_lies_ahead_or_is_that_of_the_stop) {
    output.write(4.0, now + 2s);
    stop();
    expect_abandoned();
    force_input(9.0);
    output.write(5.0, now);
    stop();
    expect_abandoned();
}

TEST_P(AbandonedValue, stays_so_when_it_is_forced_again_and_released) {
    stop();
    expect_abandoned();
    force_input(9.0);
    EXPECT_EQ(input.get(), 9.0);
    port.release(&input, true);
    expect_abandoned();
}

TEST_P(AbandonedValue, is_wanted_again_when_the_reader_stood_and_its_writer_did_not) {
    restart_reader();
    expect(1.0);
}

TEST_P(AbandonedValue, is_one_when_its_writer_stops_while_the_reader_stands) {
    port.end_force(&input, true);
    stop();
    port.resume(&input);
    expect_abandoned();
}

TEST_P(AbandonedValue, stays_so_when_it_is_forced_again_and_the_reader_starts_anew) {
    stop();
    expect_abandoned();
    force_input(9.0);
    restart_reader();
    expect_abandoned();
    force_input(9.0);
    output.write(2.0);
    restart_reader();
    expect(2.0);
}

TEST_P(AbandonedValue, is_what_the_force_of_an_output_hid_with_or_without_one_of_the_input) {
    force_output(8.0);
    stop();
    expect_abandoned();
    output.write(2.0);
    expect(2.0);
    force_output(8.0);
    stop();
    expect_abandoned();
    output.write(3.0);
    force_output(8.0);
    begin_stop();
    output.write(0.5);
    end_stop();
    expect(0.5);
}

TEST_P(AbandonedValue, is_none_of_a_force_that_came_during_the_stop) {
    port.release(&input, true);
    begin_stop();
    output.write(0.5);
    force_input(9.0);
    end_stop();
    expect(0.5);
}

TEST_P(AbandonedValue, is_none_of_a_writer_that_is_stopped_once_more_and_runs_again) {
    begin_stop();
    output.write(0.5);
    end_stop();
    expect(0.5);
    force_input(9.0);
    writer.count += Stops::of_one_that_stood;
    expect(0.5);
    force_input(9.0);
    writer.count += Stops::of_one_that_stood;
    output.write(2.0);
    expect(2.0);
}

TEST_P(AbandonedValue, stays_one_when_the_force_is_released_after_the_stop_and_before_anybody_looks) {
    stop();
    port.release(&input, true);
    expect_abandoned();
}

/// Two outputs write one input by turns, as a machine's chains do.
struct AbandonedByTurns : AbandonedValue {
    Output<double> other;
    Stops other_writer;
    AbandonedByTurns() {
        port.set_clock(&other, false, &now);
        other.write(7.0);
    }
    void turn_to(Output<double>& next, const Stops& by) { port.link_local(&input, &next, &by); }
};

INSTANTIATE_TEST_SUITE_P(, AbandonedByTurns, testing::Values(false));

TEST_P(AbandonedByTurns, stays_so_when_a_turn_is_refused) {
    stop();
    expect_abandoned();
    turn_to(other, other_writer);
    expect(7.0);
    turn_to(output, writer);
    expect_abandoned();
}

TEST_P(AbandonedByTurns, is_none_of_the_next_turn_however_few_it_wrote) {
    for (int i = 0; i < 50; ++i) output.write(1.0);
    stop();
    expect_abandoned();
    turn_to(other, other_writer);
    port.forget(&output);
    turn_to(output, writer);
    EXPECT_EQ(input.read(value), Flow::never_written);
    output.write(2.0);
    expect(2.0);
}

TEST_P(AbandonedByTurns, is_what_the_force_hid_that_was_handed_over) {
    turn_to(other, other_writer);
    stop();
    port.hand_force_to(&input, &other_writer);
    EXPECT_EQ(input.get(), 9.0);
    other.write(8.0);
    port.begin_life(&other, life_after(other_writer.count));
    other_writer.count += Stops::of_a_life;
    expect_abandoned();
}

TEST_P(AbandonedByTurns, counts_what_all_of_them_wrote) {
    port.release(&input, true);
    expect(1.0);
    const std::uint64_t before = input.writes();
    turn_to(other, other_writer);
    turn_to(output, writer);
    EXPECT_EQ(input.writes(), before) << "the turn was refused";
    turn_to(other, other_writer);
    port.hand_force_to(&input, &other_writer);
    EXPECT_GT(input.writes(), before);
}

} // namespace

// Forced ports (thesis 4.8: a browser changes what a task reads and writes): the forced value flows whatever
// the component does, and a release leaves no trace.
#include "tests/kernel/component/port_rig.hpp"

namespace {

using namespace tappet;

struct Forcing : PortsOfEachTopology {
    void force_output(double to) { port.force(&output, false, reinterpret_cast<const std::byte*>(&to)); }
    void force_input(double to) { port.force(&input, true, reinterpret_cast<const std::byte*>(&to)); }
    template <class T> static T at(const void* place) { return *static_cast<const T*>(place); }
};

INSTANTIATE_TEST_SUITE_P(, Forcing, testing::Bool(), topology);

TEST_P(Forcing, publishes_the_forced_output_instead_of_component_writes) {
    output.write(1.0);
    force_output(9.0);
    EXPECT_EQ(read(), (Read{Flow::fresh, 9.0}));
    output.write(2.0);
    EXPECT_EQ(read(), (Read{Flow::fresh, 9.0})) << "each write stays a sign of life";
    EXPECT_EQ(output.last(), 2.0) << "what the component knows of its own is what it wrote";
}

TEST_P(Forcing, publishes_the_last_written_value_on_release_of_an_output) {
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

TEST_P(Forcing, is_refused_for_an_output_that_was_never_written) {
    const double to = 9.0;
    EXPECT_FALSE(port.force(&output, false, reinterpret_cast<const std::byte*>(&to)));
    EXPECT_EQ(input.read(value), Flow::never_written);
    port.release(&output, false);
    EXPECT_EQ(input.read(value), Flow::never_written);
}

TEST_P(Forcing, keeps_the_age_of_a_value_on_release_of_an_output) {
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

TEST_P(Forcing, makes_an_input_fresh_once_and_never_stale) {
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

TEST_P(Forcing, ends_when_the_writer_has_left_its_safe_value) {
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

TEST_P(Forcing, accepts_an_input_that_was_never_written) {
    force_input(9.0);
    EXPECT_EQ(read(), (Read{Flow::fresh, 9.0}));
    port.release(&input, true);
    EXPECT_EQ(read(), (Read{Flow::never_written, 0.0}));
}

TEST_P(Forcing, shows_the_connected_value_again_on_release_of_an_input) {
    output.write(1.0);
    EXPECT_EQ(input.get(), 1.0);
    force_input(9.0);
    EXPECT_EQ(input.get(), 9.0);
    port.release(&input, true);
    EXPECT_EQ(read(), (Read{Flow::fresh, 1.0})) << "although nothing was written meanwhile";
}

TEST_P(Forcing, ignores_the_release_of_an_unforced_port) {
    output.write(1.0);
    EXPECT_EQ(input.get(), 1.0);
    port.release(&input, true);
    port.release(&output, false);
    EXPECT_EQ(read(), (Read{Flow::old, 1.0}));
}

TEST_P(Forcing, shows_an_observer_value_time_and_flag) {
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

/// The writer and the reader of a forced value, as engines stop and start them.
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

TEST_P(AbandonedValue, is_the_value_hidden_by_a_force_that_a_stop_ended) {
    stop();
    expect_abandoned();
    output.write(2.0);
    expect(2.0);
}

TEST_P(AbandonedValue, excludes_the_safe_value_of_a_stop_whatever_its_time) {
    begin_stop();
    output.write(0.5, at_ns(0));
    end_stop();
    expect(0.5);
}

TEST_P(AbandonedValue, excludes_a_value_written_after_the_stop) {
    stop();
    output.write(3.0, at_ns(0));
    expect(3.0);
}

TEST_P(AbandonedValue, excludes_the_safe_value_when_a_second_stop_follows) {
    begin_stop();
    output.write(0.5);
    end_stop();
    stop();
    expect(0.5);
}

TEST_P(AbandonedValue, includes_values_stamped_at_the_stop_or_in_the_future) {
    output.write(4.0, now + 2s);
    stop();
    expect_abandoned();
    force_input(9.0);
    output.write(5.0, now);
    stop();
    expect_abandoned();
}

TEST_P(AbandonedValue, stays_abandoned_after_another_force_and_its_release) {
    stop();
    expect_abandoned();
    force_input(9.0);
    EXPECT_EQ(input.get(), 9.0);
    port.release(&input, true);
    expect_abandoned();
}

TEST_P(AbandonedValue, becomes_valid_when_only_the_reader_restarts) {
    restart_reader();
    expect(1.0);
}

TEST_P(AbandonedValue, includes_values_whose_writer_stops_while_the_reader_is_stopped) {
    port.end_force(&input, true);
    stop();
    port.resume(&input);
    expect_abandoned();
}

TEST_P(AbandonedValue, stays_abandoned_after_another_force_and_a_reader_restart) {
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

TEST_P(AbandonedValue, includes_the_value_hidden_by_a_force_of_the_output) {
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

TEST_P(AbandonedValue, excludes_the_safe_value_when_the_force_began_during_the_stop) {
    port.release(&input, true);
    begin_stop();
    output.write(0.5);
    force_input(9.0);
    end_stop();
    expect(0.5);
}

TEST_P(AbandonedValue, excludes_the_safe_value_when_a_stopped_writer_stops_again) {
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

TEST_P(AbandonedValue, stays_abandoned_when_the_force_is_released_after_the_stop) {
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

TEST_P(AbandonedByTurns, stays_abandoned_when_a_turn_is_refused) {
    stop();
    expect_abandoned();
    turn_to(other, other_writer);
    expect(7.0);
    turn_to(output, writer);
    expect_abandoned();
}

TEST_P(AbandonedByTurns, excludes_values_of_the_next_turn_however_few) {
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

TEST_P(AbandonedByTurns, is_the_value_hidden_by_a_handed_over_force) {
    turn_to(other, other_writer);
    stop();
    port.hand_force_to(&input, &other_writer);
    EXPECT_EQ(input.get(), 9.0);
    other.write(8.0);
    port.begin_life(&other, life_after(other_writer.count));
    other_writer.count += Stops::of_a_life;
    expect_abandoned();
}

TEST_P(AbandonedByTurns, counts_the_writes_of_all_writers) {
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

// Forced ports (thesis 4.8: a browser changes what a task reads and writes): what is forced is what flows,
// whatever the component does, and releasing leaves no trace.
#include "kernel/component/facet.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

namespace {

using namespace tappet;

/// An output and an input, linked as start-up links them, in one activity or across two.
class Forcing : public testing::TestWithParam<bool> {
protected:
    static constexpr const PortOperations& port = PortAccess::data<double>;
    Output<double> output;
    Input<double> input;
    Time now = at_ns(0);
    double value = -1;
    alignas(512) std::array<std::byte, 8192> memory{};

    Forcing() {
        port.set_clock(&output, false, &now);
        port.set_clock(&input, true, &now);
        if (GetParam()) port.place_shared(&output, memory.data());
        link(nullptr);
    }
    void link(const Stops* writer) {
        if (GetParam())
            port.link_shared(&input, &output, writer);
        else
            port.link_local(&input, &output, writer);
    }
    void force_output(double to) { port.force(&output, false, reinterpret_cast<const std::byte*>(&to)); }
    void force_input(double to) { port.force(&input, true, reinterpret_cast<const std::byte*>(&to)); }
    template <class T> static T at(const void* place) { return *static_cast<const T*>(place); }
};

INSTANTIATE_TEST_SUITE_P(, Forcing, testing::Bool(), [](const auto& each) {
    return each.param ? "across_activities" : "inside_one_activity";
});

TEST_P(Forcing, an_output_publishes_the_forced_value_at_once_and_whatever_its_component_writes) {
    output.write(1.0);
    force_output(9.0);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(value, 9.0);
    output.write(2.0);
    EXPECT_EQ(input.read(value), Flow::fresh) << "each write stays a sign of life";
    EXPECT_EQ(value, 9.0);
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
    EXPECT_EQ(input.read(value), Flow::fresh) << "written meanwhile";
    EXPECT_EQ(value, 2.0);
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
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(value, 9.0);
    output.write(2.0);
    EXPECT_EQ(input.read(value), Flow::old);
    EXPECT_EQ(value, 9.0);
    now += 1h;
    EXPECT_EQ(input.read(value), Flow::old);
    EXPECT_EQ(value, 9.0);
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
    output.write(0.0);
    EXPECT_EQ(input.get(), 9.0);
    ++writer.count;
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(value, 0.0);
    EXPECT_EQ(forced, 0u);
    force_input(9.0);
    EXPECT_EQ(input.get(), 9.0) << "forced after that";
}

TEST_P(Forcing, an_input_that_nobody_ever_wrote_can_be_forced) {
    force_input(9.0);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(value, 9.0);
    port.release(&input, true);
    EXPECT_EQ(input.read(value), Flow::never_written);
    EXPECT_EQ(value, 0.0);
}

TEST_P(Forcing, releasing_an_input_reads_again_what_stands_at_the_other_end) {
    output.write(1.0);
    EXPECT_EQ(input.get(), 1.0);
    force_input(9.0);
    EXPECT_EQ(input.get(), 9.0);
    port.release(&input, true);
    EXPECT_EQ(input.read(value), Flow::fresh);
    EXPECT_EQ(value, 1.0) << "although nothing was written meanwhile";
}

TEST_P(Forcing, releasing_what_is_not_forced_changes_nothing) {
    output.write(1.0);
    EXPECT_EQ(input.get(), 1.0);
    port.release(&input, true);
    port.release(&output, false);
    EXPECT_EQ(input.read(value), Flow::old);
    EXPECT_EQ(value, 1.0);
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

/// The writer of what is forced, as an engine stops it.
struct AbandonedValue : Forcing {
    Stops writer;
    AbandonedValue() {
        link(&writer);
        now = at_ns(0) + 1s;
        output.write(1.0);
        force_input(9.0);
    }
    void stop() {
        now += 1s;
        port.note_life(&output, false);
    }
    void expect(double wanted, bool is_abandoned) {
        EXPECT_EQ(input.get(), wanted);
        EXPECT_EQ(input.is_abandoned(), is_abandoned);
    }
};

INSTANTIATE_TEST_SUITE_P(, AbandonedValue, testing::Bool(), [](const auto& each) {
    return each.param ? "across_activities" : "inside_one_activity";
});

TEST_P(AbandonedValue, is_what_a_force_hid_when_it_ended_with_a_stop) {
    stop();
    ++writer.count;
    expect(1.0, true);
    output.write(2.0);
    expect(2.0, false);
}

TEST_P(AbandonedValue, is_none_that_a_stop_left_whatever_its_time) {
    stop();
    output.write(0.0, at_ns(0));
    ++writer.count;
    expect(0.0, false);
}

TEST_P(AbandonedValue, is_none_that_is_written_after_a_stop_before_anybody_looks) {
    stop();
    ++writer.count;
    output.write(3.0, at_ns(0));
    expect(3.0, false);
}

TEST_P(AbandonedValue, is_one_whose_time_lies_ahead_or_is_that_of_the_stop) {
    output.write(4.0, now + 2s);
    stop();
    ++writer.count;
    expect(4.0, true);
    force_input(9.0);
    output.write(5.0, now);
    port.note_life(&output, false);
    ++writer.count;
    expect(5.0, true);
}

TEST_P(AbandonedValue, stays_so_when_it_is_forced_again_and_released) {
    stop();
    ++writer.count;
    expect(1.0, true);
    force_input(9.0);
    expect(9.0, false);
    port.release(&input, true);
    expect(1.0, true);
}

TEST_P(AbandonedValue, is_wanted_again_when_the_reader_stood_and_its_writer_did_not) {
    port.end_force(&input, true);
    expect(1.0, true);
    port.note_life(&input, true);
    expect(1.0, false);
    force_input(9.0);
    stop();
    ++writer.count;
    port.end_force(&input, true);
    port.note_life(&input, true);
    expect(1.0, true);
}

} // namespace

// Blocking functionality (thesis 4.2.2: trigger semantics, loop and breakLoop): it keeps its thread, serves
// its messages while it waits, and returns when its activity stops; in real and in virtual time.
#include "kernel/component/loop.hpp"

#include "tests/kernel/machine/real_rig.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <vector>

#include <poll.h>

namespace tappet {
namespace {

/// Reads bytes from a blocking pipe, or waits through the control; writes the data it received.
struct Reader {
    Output<std::int64_t> got;
    std::atomic<int> loops{0}, breaks{0}, starts{0}, stops{0}, told{0}, told_outside{0};
    std::atomic<bool> in_loop{false};
    std::atomic<int> from{-1}; ///< a pipe; -1: waits through the control
    std::atomic<bool> returns_at_once{false};
    int end_pipe[2] = {-1, -1};
    Duration nap{3ms};
    std::vector<Time> naps_ended;

    Sentence configure(Setup&) {
        if (end_pipe[0] < 0 && pipe(end_pipe) != 0) return Sentence{"no pipe"};
        return {};
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME { ++starts; }
    void loop(LoopControl& control) {
        ++loops;
        in_loop = true;
        if (!returns_at_once) {
            if (from >= 0)
                read_on(control);
            else
                while (control.wait(nap)) {
                    naps_ended.push_back(control.now());
                    got.write(got.last() + 1);
                }
        }
        in_loop = false;
    }
    void break_loop() {
        ++breaks;
        const char end = 'e';
        [[maybe_unused]] const auto n = write(end_pipe[1], &end, 1);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        ++stops;
        got.write(-1);
    }
    void tell() noexcept TAPPET_REALTIME {
        ++told;
        if (!in_loop) ++told_outside;
    }
    static constexpr auto interface() {
        return facets(output<&Reader::got>("got", "", "counts; -1: safe"),
                      operation<&Reader::tell>("tell", "counts"));
    }

private:
    void read_on(LoopControl& control) {
        while (true) {
            pollfd both[2] = {{from, POLLIN, 0}, {end_pipe[0], POLLIN, 0}};
            poll(both, 2, -1);
            char byte = 0;
            if (both[1].revents != 0) [[maybe_unused]]
                const auto n = read(end_pipe[0], &byte, 1);
            else if (read(from, &byte, 1) == 1)
                got.write(byte);
            if (!control.serve()) return;
        }
    }
};

struct Talker {
    Input<std::int64_t> heard;
    Event<> speak;
    std::atomic<int> to_say{0};
    std::atomic<std::int64_t> last{0};
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        last = heard.get();
        if (to_say > 0) {
            --to_say;
            speak();
        }
    }
    static constexpr auto interface() {
        return facets(input<&Talker::heard>("heard", "", "of the reader"),
                      event<&Talker::speak>("speak", "tells it"));
    }
};

// clang-format off
constexpr auto table = machine("reading",
    components(component<Reader>("reader"), component<Talker>("talker")),
    activities(
        activity("blocks", on_work(), not_real_time, runs("reader"), stack(256 * 1024)),
        activity("talks",  every(1ms), budget(50us), runs("talker"), stack(256 * 1024))),
    connections(data("reader.got", "talker.heard")),
    reactions(when("talker.speak", tell("reader.tell"))),
    behaviours());
constexpr std::size_t blocks = 0;
// clang-format on

struct ALoopInVirtualTime : testing::Test, ConfiguredRig<table> {
    ~ALoopInVirtualTime() override { world.stop(); }
    Reader& reader = the<Reader>("reader");
    Talker& talker = the<Talker>("talker");
};

TEST_F(ALoopInVirtualTime, waits_by_the_machine_clock_and_stamps_its_outputs_with_it) {
    ASSERT_EQ(world.start().view(), "");
    pass(10ms);
    EXPECT_THAT(reader.naps_ended, testing::ElementsAre(at_ns(0) + 3ms, at_ns(0) + 6ms, at_ns(0) + 9ms));
    EXPECT_EQ(talker.last, 3);
    EXPECT_EQ(reader.loops, 1);
}

TEST_F(ALoopInVirtualTime, is_woken_by_a_message_and_serves_it_inside_the_loop) {
    reader.nap = 1h;
    ASSERT_EQ(world.start().view(), "");
    talker.to_say = 2;
    pass(10ms);
    EXPECT_EQ(reader.told, 2);
    EXPECT_EQ(reader.told_outside, 0);
    EXPECT_THAT(reader.naps_ended, testing::ElementsAre(at_ns(0) + 1ms, at_ns(0) + 2ms));
}

TEST_F(ALoopInVirtualTime, returns_with_safe_values_at_a_stop_and_restarts_at_a_start) {
    ASSERT_EQ(world.start().view(), "");
    pass(10ms);
    EXPECT_EQ(world.change_activity(blocks, LifeChange::stop).view(), "");
    EXPECT_FALSE(reader.in_loop);
    EXPECT_EQ(reader.breaks, 1);
    EXPECT_EQ(reader.stops, 1);
    pass(5ms);
    EXPECT_EQ(talker.last, -1);
    EXPECT_EQ(world.change_activity(blocks, LifeChange::start).view(), "");
    pass(10ms);
    EXPECT_TRUE(reader.in_loop);
    EXPECT_EQ(reader.loops, 2);
    EXPECT_EQ(reader.starts, 2);
}

TEST_F(ALoopInVirtualTime, runs_again_only_upon_the_next_wake_after_it_returned) {
    reader.returns_at_once = true;
    ASSERT_EQ(world.start().view(), "");
    pass(50ms);
    EXPECT_EQ(reader.loops, 1);
    talker.to_say = 1;
    pass(50ms);
    EXPECT_EQ(reader.loops, 2);
    EXPECT_EQ(reader.told, 1);
}

TEST_F(ALoopInVirtualTime, treats_a_request_to_its_component_as_one_to_its_activity) {
    ASSERT_EQ(world.start().view(), "");
    pass(5ms);
    const LifeTicket ticket = instance.life().ask_component(0, LifeChange::restart);
    pass(5ms);
    EXPECT_EQ(instance.life().answer_of_component(0, ticket).outcome, LifeOutcome::done);
    EXPECT_EQ(reader.starts, 2);
    EXPECT_TRUE(reader.in_loop);
}

TEST_F(ALoopInVirtualTime, repeats_exactly_in_every_run) {
    const auto digest = [](int words) {
        ConfiguredRig<table> again;
        again.the<Reader>("reader").nap = 700us;
        EXPECT_EQ(again.world.start().view(), "");
        again.the<Talker>("talker").to_say = words;
        EXPECT_TRUE(again.run(200ms));
        again.world.stop();
        return again.instance.observation().event_log_digest();
    };
    EXPECT_EQ(digest(100), digest(100));
    EXPECT_NE(digest(100), digest(99));
}

struct ALoopInRealTime : InRealTime, RealRig<table> {
    Reader* reader = &the<Reader>("reader");
    Talker* talker = &the<Talker>("talker");
    int input[2] = {-1, -1};

    void SetUp() override {
        InRealTime::SetUp();
        if (IsSkipped()) return;
        ASSERT_EQ(pipe(input), 0);
        const auto armed = arm();
        ASSERT_TRUE(armed);
        reader->from = input[0];
        ASSERT_TRUE(world.start(*armed));
    }
    void say(char byte) { ASSERT_EQ(write(input[1], &byte, 1), 1); }
    template <class Condition> bool comes_true(Condition&& condition) {
        for (int n = 0; n < 200 && !condition(); ++n) static_cast<void>(world.supervise(10ms));
        return condition();
    }
};

TEST_F(ALoopInRealTime, may_block_anywhere_and_passes_its_values_to_others) {
    say(42);
    EXPECT_TRUE(comes_true([&] { return talker->last == 42; }));
    say(7);
    EXPECT_TRUE(comes_true([&] { return talker->last == 7; }));
    EXPECT_EQ(world.stop(), 0);
}

TEST_F(ALoopInRealTime, is_interrupted_by_the_stopper_and_restarted_on_the_same_thread) {
    EXPECT_TRUE(comes_true([&] { return reader->in_loop.load(); }));
    for (int n = 1; n <= 20; ++n) {
        ASSERT_EQ(world.change_activity(blocks, LifeChange::restart).view(), "");
        ASSERT_EQ(reader->breaks, n);
        ASSERT_EQ(reader->stops, n);
        ASSERT_EQ(reader->starts, n + 1);
    }
    say(9);
    EXPECT_TRUE(comes_true([&] { return talker->last == 9; }));
    EXPECT_EQ(world.stop(), 0);
    EXPECT_FALSE(reader->in_loop);
}

TEST_F(ALoopInRealTime, serves_its_messages_inside_the_loop) {
    talker->to_say = 3;
    EXPECT_TRUE(comes_true([&] { return talker->to_say == 0; }));
    say(1); // it blocks in the read until then
    EXPECT_TRUE(comes_true([&] { return reader->told == 3; }));
    EXPECT_EQ(reader->told_outside, 0);
    EXPECT_EQ(world.stop(), 0);
}

} // namespace
} // namespace tappet

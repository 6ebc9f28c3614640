// SPDX-License-Identifier: Apache-2.0
// A stop makes the outputs safe within the board's bound while a user function runs for seconds: for each
// cause of a stop, in each such situation.
#include "kernel/component/loop.hpp"
#include "tests/kernel/machine/parts.hpp"
#include "tests/kernel/machine/real_rig.hpp"

#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tappet {
namespace {

/// The events in order; filled by threads without real time, and by stops.
struct Log {
    std::mutex mutex;
    std::vector<std::string> lines;
    void add(std::string_view who, std::string_view what) {
        const std::lock_guard lock{mutex};
        lines.push_back(std::string{who} + " " + std::string{what});
    }
};
Log& history() {
    static Log log;
    return log;
}

/// Its output represents a wire: 1 while it runs, 0 is safe.
struct Valve : Clocked {
    Input<std::int64_t> beat;
    std::atomic<std::int64_t> at_wire{0}, safe_since{0};
    std::atomic<bool> hears{false}, breaks_contract{false}, takes_long{false};
    void start(const Cycle&) noexcept TAPPET_REALTIME { at_wire = 1; }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        TAPPET_CONTRACT(!breaks_contract.load(), Contract::precondition, 7);
        if (beat.good()) hears = true;
        if (takes_long.exchange(false)) clock->consume(150ms);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        at_wire = 0;
        safe_since = to_ns(clock->now());
        TAPPET_ESCAPE("a test's note", history().add("valve", "stop"));
    }
    static constexpr auto interface() { return facets(input<&Valve::beat>("beat", "", "of the pulse")); }
};

struct Pulse {
    Output<std::int64_t> beat;
    std::atomic<bool> silent{false}, hangs{false}, hangs_in_stop{false};
    std::atomic<int> stopped{0};
    /// Other threads use its processor meanwhile.
    static void hang(const std::atomic<bool>& while_so) noexcept TAPPET_REALTIME {
        while (while_so) TAPPET_ESCAPE("it shall hang", os::sleep_for(1ms));
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (!silent) beat.write(beat.last() + 1);
        hang(hangs);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        hang(hangs_in_stop);
        ++stopped;
    }
    static constexpr auto interface() { return facets(output<&Pulse::beat>("beat", "", "counts")); }
};

enum class Function : int { none, initialise, finalise, start, work, stop, loop, break_loop };
constexpr auto for_seconds = 4s;

/// One of its functions takes seconds, or until the test releases it.
struct Slow {
    std::atomic<Function> slow{Function::none}, at{Function::none};
    std::atomic<bool> let_go{false}, breaks_contract{false};
    std::atomic<int> initialised{0}, finalised{0}, stopped{0};

    void take(Function function) noexcept {
        if (slow != function) return;
        at = function;
        for (int n = 0; n < for_seconds / 1ms && !let_go; ++n) os::sleep_for(1ms);
    }
    Sentence initialise() {
        take(Function::initialise);
        TAPPET_CONTRACT(!breaks_contract.load(), Contract::precondition, 9);
        ++initialised;
        return {};
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("it shall block", take(Function::start));
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        TAPPET_ESCAPE("it shall block", take(Function::stop); history().add("slow", "stop"));
        ++stopped;
    }
    void finalise() {
        take(Function::finalise);
        ++finalised;
        history().add("slow", "finalise");
    }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
struct Camera : Slow {
    void work(const Cycle&) { take(Function::work); }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};
struct Receiver : Slow {
    void loop(LoopControl& control) {
        take(Function::loop);
        while (control.wait(1h)) {
        }
    }
    void break_loop() { take(Function::break_loop); }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

// clang-format off
constexpr auto table = machine("stopping",
    components(component<Valve>("valve"), component<Pulse>("pulse"), component<Pulse>("spare"), component<Receiver>("receiver"), component<Camera>("camera")),
    activities(
        activity("drivers", every(100ms), runs("valve"), budget(50us), stack(256 * 1024), stop_when_late),
        activity("logic",   every(5ms),  runs("pulse"), budget(50us), stack(256 * 1024)),
        activity("spare",   every(5ms),  runs("spare"), budget(50us), stack(256 * 1024)),
        activity("receive", on_work(),   not_real_time, runs("receiver"), stack(256 * 1024)),
        activity("look",    every(10ms), not_real_time, runs("camera"),   stack(256 * 1024))),
    connections(data("pulse.beat", "valve.beat", stale_after(500ms), stop_machine)),
    reactions(), behaviours());
constexpr std::size_t drivers = 0, spare = 2, receive = 3, look = 4;
// clang-format on

enum class Cause { stale_row, contract, missed_deadline, termination, one_that_asks };
enum class Situation {
    initialises, ///< a restart of the camera
    finalises,
    starts,
    works, ///< it blocks in work()
    stops, ///< with the machine
    loops, ///< and does not return
    breaks_loop,
    machine_starts ///< and initialises the camera
};
/// Same order as the situations.
constexpr struct {
    Situation situation;
    Function slow;
    std::string_view name;
} situations[] = {{Situation::initialises, Function::initialise, "the_camera_initialises"},
                  {Situation::finalises, Function::finalise, "the_camera_finalises"},
                  {Situation::starts, Function::start, "the_camera_starts"},
                  {Situation::works, Function::work, "the_camera_works"},
                  {Situation::stops, Function::stop, "the_camera_stops"},
                  {Situation::loops, Function::loop, "the_receiver_loops"},
                  {Situation::breaks_loop, Function::break_loop, "its_loop_is_broken_off"},
                  {Situation::machine_starts, Function::initialise, "the_machine_starts"}};
constexpr auto& row_of(Situation situation) { return situations[static_cast<std::size_t>(situation)]; }
constexpr std::array causes{Cause::stale_row, Cause::missed_deadline, Cause::termination,
                            Cause::one_that_asks};

template <const auto& of_table> struct Rig : RealRig<of_table> {
    using RealRig<of_table>::clock, RealRig<of_table>::instance, RealRig<of_table>::world;
    Valve* valve = &this->template the<Valve>("valve");
    Pulse *pulse = &this->template the<Pulse>("pulse"), *spare = &this->template the<Pulse>("spare");
    Camera* camera = &this->template the<Camera>("camera");
    Receiver* receiver = &this->template the<Receiver>("receiver");
    std::optional<Armed> armed;

    Rig() {
        history().lines.clear();
        armed = this->arm();
        EXPECT_TRUE(armed);
    }
    /// Waits until all run, because a value that was never valid does not become stale.
    bool start() {
        return armed && world.start(*armed) && comes_true([this] { return valve->hears.load(); });
    }
    /// Supervises until the condition is true.
    template <class Condition> [[nodiscard]] bool comes_true(Condition&& condition) {
        for (const Time end = clock.now() + 20s; !condition() && clock.now() < end;)
            static_cast<void>(world.supervise(1ms));
        return condition();
    }
    void cause(Cause by) {
        switch (by) {
        case Cause::stale_row: pulse->silent = true; break;
        case Cause::contract: valve->breaks_contract = true; break;
        case Cause::missed_deadline: valve->takes_long = true; break;
        case Cause::termination: raise(SIGTERM); break;
        case Cause::one_that_asks: instance.ask_stop(StopReason::requested, 0, nullptr); break;
        }
    }
    /// One function of the camera, or of the receiver, takes seconds, either now or at its next call.
    void prepare(Situation situation) {
        const bool of_receiver = situation == Situation::loops || situation == Situation::breaks_loop;
        (of_receiver ? static_cast<Slow&>(*receiver) : *camera).slow = row_of(situation).slow;
    }
    void await_slow() const {
        while (camera->at == Function::none && receiver->at == Function::none) os::sleep_for(1ms);
    }
    /// Restarts the camera, whose initialisation takes seconds.
    void initialise_camera() {
        prepare(Situation::initialises);
        static_cast<void>(instance.life().ask_activity(look, LifeChange::restart));
        EXPECT_TRUE(comes_true([&] { return camera->at == Function::initialise; }));
    }
    [[nodiscard]] Duration until_safe() const { return at_ns(valve->safe_since) - instance.stop_asked_at(); }
};

struct AStop : InRealTime, testing::WithParamInterface<std::size_t> {};

std::ptrdiff_t threads() { return std::distance(std::filesystem::directory_iterator{"/proc/self/task"}, {}); }

/// A hung thread returns after the test: its data stay until then, and the next machine reuses its memory
/// after it has ended. A thread with a broken contract stays for ever, in memory of its own.
template <const auto& of_table> class LastingRig {
public:
    ~LastingRig() { end(); }
    Rig<of_table>* operator->() const { return &rig_; }
    void end() const {
        rig_.camera->let_go = rig_.receiver->let_go = true;
        for (Pulse* each : {rig_.pulse, rig_.spare}) each->hangs = each->hangs_in_stop = false;
        static_cast<void>(rig_.world.stop());
        if (rig_.world.breaches() != 0) return;
        for (int n = 0; n < 20'000 && threads() > before_; ++n) os::sleep_for(1ms);
        EXPECT_EQ(threads(), before_);
    }

private:
    static Rig<of_table>& made() {
        static std::vector<Rig<of_table>*> rigs;
        return *rigs.emplace_back(new Rig<of_table>);
    }
    std::ptrdiff_t before_ = threads();
    Rig<of_table>& rig_ = made();
};
constexpr auto broken_table = table, broken_beside_table = table;

TEST_P(AStop, makes_outputs_safe_within_the_bound_of_the_board) {
    static_assert(for_seconds > 2 * real_board.stop_within, "who waited for it would be late");
    for (const Cause by : causes) {
        SCOPED_TRACE(static_cast<int>(by));
        const LastingRig<table> rig;
        ASSERT_TRUE(rig->armed);
        const Situation situation = situations[GetParam()].situation;
        const bool from_the_start = situation == Situation::machine_starts || situation == Situation::loops;
        if (from_the_start) rig->prepare(situation);
        if (situation != Situation::machine_starts) {
            ASSERT_TRUE(rig->start());
        }
        if (!from_the_start) rig->prepare(situation);
        if (situation == Situation::breaks_loop)
            static_cast<void>(rig->instance.life().ask_activity(receive, LifeChange::restart));
        else if (!from_the_start && situation != Situation::works && situation != Situation::stops)
            static_cast<void>(rig->instance.life().ask_activity(look, LifeChange::restart));
        std::thread other{[&] { // whatever blocks the supervisor
            if (situation != Situation::stops) rig->await_slow();
            while (!rig->valve->hears) os::sleep_for(1ms); // otherwise nothing becomes stale
            rig->cause(by);
        }};
        if (situation == Situation::machine_starts) {
            EXPECT_FALSE(rig->armed && rig->world.start(*rig->armed));
            EXPECT_EQ(rig->world.refusal().view(), "");
        } else {
            EXPECT_TRUE(rig->comes_true([&] { return rig->instance.stop_asked(); }));
        }
        other.join();
        static_cast<void>(rig->world.make_safe());
        EXPECT_EQ(rig->valve->at_wire, 0);
        EXPECT_LT(rig->until_safe(), real_board.stop_within);
        rig.end();
        EXPECT_EQ(rig->world.unfinished().view(), "");
        EXPECT_EQ(rig->camera->finalised,
                  rig->camera->initialised - (rig->world.hung() != 0 && rig->world.first_hung() == "look"));
    }
}

INSTANTIATE_TEST_SUITE_P(While, AStop, testing::Range(std::size_t{0}, std::size(situations)),
                         [](const auto& at) { return std::string{situations[at.param].name}; });

using TheMachine = InRealTime;

TEST_F(TheMachine, stops_all_activities_before_it_finalises_any) {
    const LastingRig<table> rig;
    ASSERT_TRUE(rig->start());
    rig->camera->slow = Function::finalise;
    const Time begin = rig->clock.now();
    EXPECT_EQ(rig->world.stop(), 0);
    EXPECT_LT(at_ns(rig->valve->safe_since) - begin, real_board.stop_within);
    EXPECT_THAT(history().lines, testing::ElementsAre("slow stop", "slow stop", "valve stop", "slow finalise",
                                                      "slow finalise"));
}

TEST_F(TheMachine, stops_one_activity_at_once_while_another_initialises) {
    const LastingRig<table> rig;
    ASSERT_TRUE(rig->start());
    rig->initialise_camera();
    const Time begin = rig->clock.now();
    const LifeTicket ticket = rig->instance.life().ask_activity(drivers, LifeChange::stop);
    ASSERT_TRUE(rig->comes_true([&] { return rig->valve->safe_since != 0; }));
    EXPECT_LT(at_ns(rig->valve->safe_since) - begin, real_board.stop_within);
    rig->camera->let_go = true;
    EXPECT_TRUE(rig->comes_true([&] {
        return rig->instance.life().answer_of_activity(drivers, ticket).outcome == LifeOutcome::done;
    }));
    EXPECT_FALSE(rig->instance.stop_asked());
    EXPECT_EQ(rig->world.stop(), 0);
}

TEST_F(TheMachine, stops_other_activities_in_time_when_a_real_time_one_hangs) {
    const LastingRig<table> rig;
    ASSERT_TRUE(rig->start());
    rig->pulse->hangs = true;
    ASSERT_TRUE(rig->comes_true([&] { return rig->instance.stop_asked(); })) << "its row is stale";
    EXPECT_EQ(rig->world.make_safe(), 1);
    EXPECT_EQ(rig->world.first_hung(), "logic");
    EXPECT_EQ(rig->valve->at_wire, 0);
    EXPECT_LT(rig->until_safe(), real_board.stop_within);
    rig.end();
    EXPECT_EQ(rig->pulse->stopped, 0) << "neither the supervisor's thread nor its own, which was given up";
    EXPECT_FALSE(rig->instance.standing());
}

TEST_F(TheMachine, stops_when_an_activity_hangs_during_its_own_stop) {
    const LastingRig<table> rig;
    ASSERT_TRUE(rig->start());
    rig->spare->hangs_in_stop = true;
    const LifeTicket ticket = rig->instance.life().ask_activity(spare, LifeChange::restart);
    ASSERT_TRUE(rig->comes_true([&] { return rig->instance.stop_asked(); }));
    EXPECT_EQ(rig->instance.stop_request().reason, StopReason::activity_hangs);
    EXPECT_EQ(rig->instance.describe_stop().view(),
              "activity \"spare\" neither starts nor stops: its thread hangs");
    EXPECT_EQ(rig->instance.life().answer_of_activity(spare, ticket).refusal, LifeRefusal::thread_lost);
    EXPECT_EQ(rig->world.make_safe(), 1);
    EXPECT_EQ(rig->valve->at_wire, 0);
    EXPECT_LT(rig->until_safe(), real_board.stop_within);
    rig.end();
}

TEST_F(TheMachine, stops_in_time_for_a_broken_contract_during_an_initialisation) {
    const LastingRig<broken_beside_table> rig;
    ASSERT_TRUE(rig->start());
    rig->initialise_camera();
    rig->cause(Cause::contract);
    ASSERT_TRUE(rig->comes_true([&] { return rig->instance.stop_asked(); }));
    EXPECT_EQ(rig->world.make_safe(), 0);
    EXPECT_EQ(rig->instance.stop_request().reason, StopReason::broken_contract);
    EXPECT_EQ(rig->valve->at_wire, 0);
    EXPECT_LT(rig->until_safe(), real_board.stop_within);
    EXPECT_EQ(rig->world.lost(), 1);
}

TEST_F(TheMachine, stops_at_once_when_an_initialisation_breaks_a_contract) {
    const LastingRig<broken_table> rig;
    rig->camera->breaks_contract = true;
    EXPECT_FALSE(rig->start());
    EXPECT_EQ(rig->instance.stop_request().reason, StopReason::broken_contract);
    EXPECT_EQ(rig->world.stop(), 0);
    EXPECT_EQ(rig->valve->at_wire, 0);
    EXPECT_LT(rig->until_safe(), real_board.stop_within);
    EXPECT_THAT(std::string{rig->world.unfinished().view()},
                testing::StartsWith("activity \"look\": its initialise() or finalise() broke a contract"));
    EXPECT_FALSE(rig->instance.standing());
}

/// The last in the chain: the value read last is on the wire.
struct Wire {
    Input<std::int64_t> level;
    std::atomic<std::int64_t> at_wire{-1};
    void step(const Cycle&) noexcept TAPPET_REALTIME { at_wire.store(level.get()); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { at_wire.store(level.get()); }
    static constexpr auto interface() { return facets(input<&Wire::level>("level", "", "0: safe")); }
};
/// Blocks, and leaves its safe value when it returns.
struct Oven {
    Output<std::int64_t> heats;
    std::atomic<int> blocks_ms{5};
    void start(const Cycle&) noexcept TAPPET_REALTIME { heats.write(1); }
    void work(const Cycle&) { os::sleep_for(blocks_ms.load() * 1ms); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { heats.write(0); }
    static constexpr auto interface() { return facets(output<&Oven::heats>("heats", "", "0: safe")); }
};
// clang-format off
constexpr auto oven_table = machine("baking",
    components(component<Wire>("wire"), component<Oven>("oven")),
    activities(
        activity("wire", every(5ms),  runs("wire"), budget(50us),   stack(256 * 1024)),
        activity("oven", every(10ms), not_real_time, runs("oven"), stack(256 * 1024))),
    connections(data("oven.heats", "wire.level")), reactions(), behaviours());
// clang-format on

TEST(StopOfABlockingActivity, reaches_the_wire_or_is_reported_as_unsafe) {
    for (const int blocks_ms : {5, 150, 400}) {
        SCOPED_TRACE(blocks_ms);
        RealRig<oven_table> rig;
        ASSERT_TRUE(rig.runs());
        const Wire& wire = rig.the<Wire>("wire");
        rig.the<Oven>("oven").blocks_ms = blocks_ms;
        ASSERT_TRUE(rig.world.supervise(100ms));
        EXPECT_EQ(wire.at_wire, 1);
        const int hung = rig.world.stop();
        EXPECT_TRUE(hung != 0 || wire.at_wire == 0) << "it said that all is safe";
        if (blocks_ms < 100) {
            EXPECT_EQ(hung, 0);
        }
    }
}

} // namespace
} // namespace tappet

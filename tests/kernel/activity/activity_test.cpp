// An activity in its own thread (thesis 4.2.2: lifetime and trigger semantics): it becomes inactive, started,
// waiting, running, stopped and started again on one thread. The starter and the stopper run their own
// functions. Several threads query component states at the same time.
#include "kernel/activity/activity.hpp"

#include "kernel/base/random.hpp"
#include "kernel/os/sleep.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <pthread.h>
#include <unistd.h>

namespace tappet {
namespace {

/// Notes which thread ran each life-cycle function, and whether any ran out of order.
struct Worker {
    std::atomic<int> initialised{0}, started{0}, stepped{0}, stopped{0}, finalised{0};
    std::atomic<int> out_of_turn{0};
    std::atomic<pthread_t> initialiser{}, starter{}, stepper{}, stopper{}, finaliser{};
    std::atomic<pid_t> stepper_of_system{0};
    std::atomic<bool> hang{false};
    std::atomic<bool> runs{false};
    std::atomic<bool> refuses{false};

    static pthread_t self() noexcept TAPPET_REALTIME {
        pthread_t id{};
        TAPPET_ESCAPE("a test asks which thread this is", id = pthread_self());
        return id;
    }
    Sentence initialise() {
        initialiser = self();
        ++initialised;
        return refuses ? Sentence{"it will not"} : Sentence{};
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        starter = self();
        ++started;
        if (runs.exchange(true)) ++out_of_turn;
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        stepper = self();
        TAPPET_ESCAPE("a test asks which thread this is", stepper_of_system = gettid());
        ++stepped;
        if (!runs) ++out_of_turn;
        while (hang) {
        }
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        stopper = self();
        ++stopped;
        if (!runs.exchange(false)) ++out_of_turn;
    }
    void finalise() {
        finaliser = self();
        ++finalised;
    }
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

constexpr int patience_ms = 2000;

struct AnActivity : testing::Test {
    os::Clock clock{os::Clock::Kind::real};
    std::array<Worker, 3> workers{};
    std::array<EnginePart, 3> parts{};
    std::array<FunctionTiming, 3 * functions_per_part> functions{};
    Engine engine;
    alignas(4096) static inline std::array<std::byte, 256 * 1024> stack{};
    Activity activity;

    AnActivity() {
        for (std::size_t i = 0; i < parts.size(); ++i) {
            parts[i].name = "worker";
            parts[i].place(&workers[i]);
            parts[i].type = &component_type<Worker>;
        }
        EnginePlan plan;
        plan.name = "tested";
        plan.periodic = true;
        plan.period = 1ms;
        plan.parts = parts;
        plan.functions = functions;
        engine.place(plan, clock);
    }
    void SetUp() override {
        EXPECT_EQ(activity.state(), Activity::State::inactive);
        ASSERT_TRUE(activity.create(engine, clock, 0, -1, stack));
    }
    void TearDown() override { EXPECT_TRUE(activity.end(patience_ms)); }
    void start() {
        ASSERT_TRUE(engine.initialise().empty());
        activity.start();
        ASSERT_TRUE(activity.is_started_within(patience_ms));
        wait_for_steps(1);
    }
    [[nodiscard]] bool stops_within(int milliseconds) {
        activity.ask_to_stop(clock.now() + Activity::end_within);
        return activity.is_stopped_within(milliseconds);
    }
    void stop() {
        ASSERT_TRUE(stops_within(patience_ms));
        engine.finalise();
    }
    void wait_for_steps(int n) {
        const int before = workers[0].stepped;
        for (int i = 0; i < patience_ms && workers[0].stepped < before + n; ++i) os::sleep_for(1ms);
        ASSERT_GE(workers[0].stepped, before + n);
    }
};

TEST_F(AnActivity, is_inactive_and_runs_nothing_after_its_creation) {
    os::sleep_for(20ms);
    EXPECT_EQ(activity.state(), Activity::State::inactive);
    EXPECT_FALSE(engine.is_active());
    EXPECT_EQ(workers[0].started, 0);
}

TEST_F(AnActivity, runs_start_cycles_and_stop_on_its_own_thread_and_nothing_else) {
    start();
    wait_for_steps(3);
    stop();
    EXPECT_EQ(activity.state(), Activity::State::stopped);
    for (Worker& worker : workers) {
        EXPECT_TRUE(pthread_equal(worker.initialiser, pthread_self()));
        EXPECT_TRUE(pthread_equal(worker.finaliser, pthread_self()));
        EXPECT_FALSE(pthread_equal(worker.stepper, pthread_self()));
        EXPECT_TRUE(pthread_equal(worker.starter, worker.stepper));
        EXPECT_TRUE(pthread_equal(worker.stopper, worker.stepper));
        EXPECT_EQ(worker.out_of_turn, 0);
    }
}

TEST_F(AnActivity, restarts_any_number_of_times_on_its_own_thread) {
    start();
    const pthread_t thread = workers[0].stepper;
    for (int n = 0; n < 50; ++n) {
        stop();
        const int steps = workers[0].stepped;
        os::sleep_for(1ms);
        EXPECT_EQ(workers[0].stepped, steps) << "stopped";
        start();
        ASSERT_TRUE(pthread_equal(workers[0].stepper, thread));
    }
    stop();
    EXPECT_EQ(workers[2].started, 51);
    EXPECT_EQ(workers[2].stopped, 51);
    EXPECT_EQ(workers[2].initialised, 51);
    EXPECT_EQ(workers[2].finalised, 51);
    EXPECT_EQ(workers[2].out_of_turn, 0);
}

TEST_F(AnActivity, ignores_a_stop_before_any_start_and_a_second_stop) {
    EXPECT_TRUE(stops_within(patience_ms));
    start();
    stop();
    EXPECT_TRUE(stops_within(patience_ms));
    EXPECT_EQ(workers[0].stopped, 1);
}

TEST_F(AnActivity, finalises_earlier_components_when_one_refuses_and_does_not_start) {
    workers[1].refuses = true;
    EXPECT_EQ(engine.initialise().view(), "component \"worker\" could not be initialised: it will not");
    EXPECT_EQ(workers[0].finalised, 1);
    EXPECT_EQ(workers[1].finalised, 0);
    EXPECT_EQ(workers[2].initialised, 0);
    EXPECT_EQ(parts[1].state.load(), ComponentState::failed);
    workers[1].refuses = false;
    start();
    EXPECT_EQ(parts[1].state.load(), ComponentState::running);
    stop();
}

TEST_F(AnActivity, never_runs_its_stop_after_it_hung_and_was_abandoned) {
    start();
    workers[0].hang = true;
    os::sleep_for(5ms);
    EXPECT_FALSE(stops_within(50));
    activity.give_up();
    EXPECT_FALSE(activity.is_stopped_within(0));
    workers[0].hang = false;
    EXPECT_TRUE(activity.is_stopped_within(patience_ms));
    EXPECT_EQ(workers[0].stopped, 0);
    // No thread joins it, and it still uses this test's stack and the next one's.
    const std::string thread = "/proc/self/task/" + std::to_string(workers[0].stepper_of_system);
    for (int i = 0; i < patience_ms && std::filesystem::exists(thread); ++i) os::sleep_for(1ms);
    ASSERT_FALSE(std::filesystem::exists(thread));
}

TEST_F(AnActivity, answers_life_cycle_requests_from_many_threads) {
    start();
    constexpr int askers = 3, requests_each = 200;
    std::array<std::atomic<int>, 4> outcomes{};
    std::vector<std::thread> threads;
    for (int t = 0; t < askers; ++t)
        threads.emplace_back([&, t] {
            Random random{static_cast<std::uint64_t>(t) + 1};
            for (int n = 0; n < requests_each; ++n) {
                const auto part = static_cast<std::uint32_t>(random.below(parts.size()));
                const LifeTicket ticket = engine.ask(part, static_cast<LifeChange>(random.between(0, 2)));
                LifeAnswer answer;
                for (int i = 0; i < patience_ms * 10; ++i) {
                    answer = engine.answer_to(part, ticket);
                    if (answer.outcome != LifeOutcome::pending) break;
                    os::sleep_for(100us);
                }
                ++outcomes[static_cast<std::size_t>(answer.outcome)];
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(outcomes[static_cast<std::size_t>(LifeOutcome::pending)], 0);
    EXPECT_EQ(outcomes[static_cast<std::size_t>(LifeOutcome::refused)], 0); // they have no inputs
    EXPECT_EQ(outcomes[static_cast<std::size_t>(LifeOutcome::done)] +
                  outcomes[static_cast<std::size_t>(LifeOutcome::superseded)],
              askers * requests_each);
    EXPECT_GT(outcomes[static_cast<std::size_t>(LifeOutcome::done)], requests_each / 2);
    stop();
    for (Worker& worker : workers) {
        EXPECT_EQ(worker.out_of_turn, 0);
        EXPECT_EQ(worker.started, worker.stopped);
    }
}

} // namespace
} // namespace tappet

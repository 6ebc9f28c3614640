// How init handles a firmware that ends badly, or not at all, on a box whose time, processes and watchdog the
// test controls.
#include "board/box/custody.hpp"

#include "kernel/os/clock.hpp"
#include "tests/kernel/os/watchdog_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <map>
#include <vector>

namespace tappet::box {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr pid_t guardian = 40, worker = 50;
constexpr int killed = 128 + SIGKILL;
constexpr std::chrono::seconds within{8};

/// The end of a test's box.
struct Reset {};

class ABox : public testing::Test, public Processes {
protected:
    os::WatchdogDevice device{static_cast<int>(within.count())};
    Time time = os::Clock::monotonic();
    Custody custody{*this, device.path(), within};
    std::vector<std::string> done{}; // to processes
    std::string said{};
    std::multimap<Time, std::function<void()>> coming{};
    std::function<void()> when_asked = [] {};
    std::function<void()> when_its_machine_dies = [] {};
    Time last_kick{};
    int kicks_seen = 0;

    void after(Duration delay, const std::function<void()>& what) { coming.emplace(time + delay, what); }
    void guardian_says_safe() { custody.hear("X_TAPPET_OUTPUTS=safe"); }
    void guardian_ends(int code) { custody.firmware_ended(code); }
    void start() {
        ASSERT_TRUE(custody.hold_watchdog());
        ASSERT_TRUE(custody.hand_over());
        custody.firmware_started(guardian);
        note_kicks();
    }
    void note_kicks() {
        if (device.kicks() != kicks_seen) last_kick = time;
        kicks_seen = device.kicks();
    }
    /// Kicks and listens, as init does while nothing happens.
    void live_for(Duration span) {
        for (const Time end = time + span; time < end;) {
            pause(milliseconds{250});
            custody.kick();
            note_kicks();
        }
    }

    // ---- the services that custody uses
    Time now() override { return time; }
    void pause(milliseconds span) override {
        note_kicks();
        time += span;
        while (!coming.empty() && coming.begin()->first <= time) {
            const auto what = coming.begin()->second;
            coming.erase(coming.begin());
            what();
        }
    }
    void say(const std::string& sentence) override { said += sentence + "\n"; }
    void ask_to_end(pid_t process) override {
        done.push_back("ask " + std::to_string(process));
        when_asked();
    }
    void kill(pid_t process) override { done.push_back("kill " + std::to_string(process)); }
    void kill_children_of(pid_t process) override {
        done.push_back("kill children of " + std::to_string(process));
        when_its_machine_dies();
    }
    void kill_others() override {
        done.emplace_back("kill others");
        EXPECT_TRUE(custody.outputs_are_safe()) << "the guardian had not said so";
    }
    void reset_box() override { throw Reset{}; }
};

TEST_F(ABox, ends_a_firmware_that_stops_on_request) {
    start();
    when_asked = [&] {
        after(100ms, [&] { guardian_says_safe(); });
        after(110ms, [&] { guardian_ends(0); });
    };
    custody.end_everything();
    EXPECT_THAT(done, ElementsAre("ask 40", "kill others"));
}

TEST_F(ABox, kills_the_machine_first_and_lets_its_guardian_act) {
    start();
    when_its_machine_dies = [&] {
        after(1s, [&] { guardian_says_safe(); });
        after(2s, [&] { guardian_ends(killed); });
    };
    const Time begin = time;
    custody.end_everything();
    EXPECT_THAT(done, ElementsAre("ask 40", "kill children of 40", "kill others"));
    EXPECT_LE(time - begin, Custody::stop_patience + 3s);
}

TEST_F(ABox, does_not_wait_for_the_black_box_of_a_guardian_that_reported) {
    start();
    when_its_machine_dies = [&] { after(1s, [&] { guardian_says_safe(); }); };
    custody.end_everything();
    EXPECT_THAT(done, ElementsAre("ask 40", "kill children of 40", "kill others"));
}

TEST_F(ABox, is_reset_and_never_kills_its_guardian_when_that_is_silent) {
    start();
    EXPECT_THROW(custody.end_everything(), Reset);
    EXPECT_THAT(done, ElementsAre("ask 40", "kill children of 40"));
    EXPECT_FALSE(device.is_stood_down());
    EXPECT_GT(time - last_kick, within) << "the watchdog comes first";
    EXPECT_LT(time - last_kick, Custody::stop_patience + Custody::guardian_patience + 3 * within);
    EXPECT_THAT(said, HasSubstr("its outputs may not be safe"));
}

TEST_F(ABox, is_reset_when_its_guardian_dies_while_it_is_asked_to_end) {
    start();
    when_asked = [&] { after(100ms, [&] { guardian_ends(killed); }); };
    EXPECT_THROW(custody.end_everything(), Reset);
    EXPECT_THAT(done, ElementsAre("ask 40"));
    EXPECT_FALSE(device.is_stood_down());
    EXPECT_GT(time - last_kick, within);
}

TEST_F(ABox, stops_kicking_after_an_end_that_no_guardian_confirmed) {
    start();
    guardian_ends(killed);
    live_for(1h);
    EXPECT_EQ(device.kicks(), kicks_seen);
    EXPECT_GT(time - last_kick, 59min);
    const auto free = custody.hand_over();
    ASSERT_FALSE(free);
    EXPECT_THAT(free.error(), HasSubstr("no firmware is started"));
    const auto held = custody.hold_watchdog();
    ASSERT_FALSE(held);
    EXPECT_THAT(held.error(), HasSubstr("the outputs may not be safe"));
    // A firmware that refuses to arm says nothing about the outputs of the one before.
    custody.firmware_started(guardian);
    guardian_ends(2);
    live_for(1h);
    EXPECT_FALSE(custody.outputs_are_safe());
    EXPECT_GT(time - last_kick, 119min);
    EXPECT_THROW(custody.end_everything(), Reset);
}

TEST_F(ABox, keeps_kicking_after_a_firmware_that_touched_nothing) {
    start();
    guardian_ends(2);
    live_for(1h);
    EXPECT_LT(time - last_kick, within / 4);
    EXPECT_TRUE(custody.hand_over());
}

TEST_F(ABox, kicks_again_after_a_guardian_made_the_outputs_safe) {
    start();
    live_for(1min);
    EXPECT_GT(time - last_kick, 59s) << "it is the guardian's";
    guardian_says_safe();
    guardian_ends(killed);
    live_for(1h);
    EXPECT_LT(time - last_kick, within / 4);
    EXPECT_TRUE(custody.hand_over());
}

TEST_F(ABox, trusts_only_its_guardian) {
    start();
    for (const char* notice : {"READY=1", "X_TAPPET_OUTPUTS=unsafe", "X_TAPPET_OUTPUTS", ""})
        custody.hear(notice);
    EXPECT_FALSE(custody.outputs_are_safe());
    guardian_ends(killed);
    guardian_says_safe();
    EXPECT_FALSE(custody.outputs_are_safe()) << "of a firmware that has ended there is no guardian";
}

TEST_F(ABox, kicks_for_a_worker_and_returns_its_exit_code) {
    ASSERT_TRUE(custody.hold_watchdog());
    after(30s, [&] { custody.worker_ended(worker + 1, 7); });
    after(1min, [&] { custody.worker_ended(worker, 1); });
    EXPECT_EQ(custody.await_worker(worker, 5min), 1);
    EXPECT_LT(time - last_kick, within / 4);
    EXPECT_TRUE(done.empty());
}

TEST_F(ABox, kills_a_worker_that_takes_too_long) {
    ASSERT_TRUE(custody.hold_watchdog());
    after(5min + 1s, [&] { custody.worker_ended(worker, killed); });
    EXPECT_EQ(custody.await_worker(worker, 5min), std::nullopt);
    EXPECT_THAT(done, ElementsAre("kill 50"));
    EXPECT_LT(time - last_kick, within / 4);
}

TEST_F(ABox, is_reset_when_a_worker_cannot_even_be_killed) {
    ASSERT_TRUE(custody.hold_watchdog());
    after(2h, [] { throw std::runtime_error("it waits without end"); });
    const Time begin = time;
    EXPECT_THROW(static_cast<void>(custody.await_worker(worker, 5min)), Reset);
    EXPECT_THAT(done, ElementsAre("kill 50"));
    EXPECT_LE(last_kick - begin, 5min + Custody::gone_patience + 1s);
    EXPECT_GT(time - last_kick, within) << "the watchdog comes first";
}

TEST_F(ABox, limits_the_time_for_which_it_kicks) {
    ASSERT_TRUE(custody.hold_watchdog());
    const Time begin = time;
    for (const Time until = time + 5min; time < begin + 1h;) {
        pause(milliseconds{250});
        custody.kick_until(until);
        note_kicks();
    }
    EXPECT_LE(last_kick - begin, 5min);
    EXPECT_GE(last_kick - begin, 4min);
}

TEST_F(ABox, without_a_watchdog_resets_itself) {
    Custody bare{*this, "", within};
    ASSERT_TRUE(bare.hold_watchdog());
    ASSERT_TRUE(bare.hand_over());
    bare.firmware_started(guardian);
    bare.firmware_ended(killed);
    const Time begin = time;
    EXPECT_THROW(bare.await_reset(), Reset);
    EXPECT_LT(time - begin, 10s);
}

} // namespace
} // namespace tappet::box

// Parts of the car tracker are stopped and started again while the rest keeps running. The task starts after
// the parts that it commands: it switches them on.
#include "apps/car_tracking/camera.hpp"
#include "apps/car_tracking/image_recognition.hpp"
#include "tests/apps/car_tracking/car_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace tappet::car_tracking {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr Duration to_wait = 500ms;       ///< from the start until it waits for buttons
constexpr Duration to_follow_again = 14s; ///< from the panel's start until it follows the car
constexpr Duration in_between = 41s;      ///< it has followed the car and is ready to do so again

struct Restarted : testing::Test {
    CarRun run{2};
    Restarted() { EXPECT_TRUE(run.start()); }
    ~Restarted() override { run.stop(); }

    /// Returns the reason for a refusal; empty: accepted.
    std::string change(std::string_view name, LifeChange how) {
        MachineInstance& machine = run.instance();
        const std::size_t c = find_component(machine.machine().table, name);
        const LifeTicket ticket = machine.life().ask_component(c, how);
        EXPECT_TRUE(run.run_for(200ms)) << name << ": " << machine.describe_stop().view();
        const LifeAnswer answer = machine.life().answer_of_component(c, ticket);
        return std::string{machine.life().describe(machine.machine().index.activity[c], answer).view()};
    }
    [[nodiscard]] ComponentState state_of(std::string_view name) {
        MachineInstance& machine = run.instance();
        return machine.life().state_of(find_component(machine.machine().table, name));
    }
    void stop(std::string_view name) {
        EXPECT_THAT(change(name, LifeChange::stop), IsEmpty());
        EXPECT_EQ(state_of(name), ComponentState::stopped) << name;
    }
    void start(std::string_view name) {
        EXPECT_THAT(change(name, LifeChange::start), IsEmpty());
        EXPECT_EQ(state_of(name), ComponentState::running) << name;
    }
    /// The panel's day begins again when the panel starts.
    void expect_follows_the_car_again() {
        const std::size_t before = run.looks().size();
        EXPECT_TRUE(run.run_for(to_follow_again)) << run.instance().describe_stop().view();
        EXPECT_EQ(run.state(), "LocaliseCar");
        ASSERT_GT(run.looks().size(), before);
        for (std::size_t i = before; i < run.looks().size(); ++i) {
            const Look& look = run.looks()[i];
            if (!look.located || !look.whole) continue;
            EXPECT_LT(look.error_m(), 0.05) << "at " << look.at_s << " s";
        }
    }
};

TEST_F(Restarted, every_component_runs_again_after_its_own_restart) {
    EXPECT_TRUE(run.run_for(in_between));
    ASSERT_EQ(run.state(), "ReadyForLocalisation");
    for (const char* name : {"camera", "recognition", "tracking", "panel"}) {
        stop(name);
        start(name);
    }
    EXPECT_EQ(run.state(), "Waiting");
    expect_follows_the_car_again();
}

TEST_F(Restarted, every_component_runs_again_after_all_were_stopped) {
    EXPECT_TRUE(run.run_for(in_between));
    for (const char* name : {"camera", "recognition", "tracking", "panel"}) stop(name);
    EXPECT_EQ(run.state(), "Shutdown") << "that nobody is there to be switched off is no error";
    for (const char* name : {"camera", "recognition", "tracking", "panel"}) start(name);
    EXPECT_EQ(run.state(), "Waiting");
    expect_follows_the_car_again();
}

TEST_F(Restarted, the_task_switches_camera_and_recognition_off_before_it_stops) {
    EXPECT_TRUE(run.run_for(in_between));
    auto& recognition = *run.instance().find<ImageRecognition>("recognition");
    stop("tracking");
    EXPECT_EQ(run.state(), "Shutdown");
    EXPECT_FALSE(run.scene().is_on()) << "the camera";
    EXPECT_FALSE(recognition.begin_processing()) << "the second command of the final state";
}

TEST_F(Restarted, the_task_ends_before_it_starts_again) {
    struct Part {
        Duration of_the_day;
        std::string_view state;
    };
    for (const Part part : {Part{500ms, "Waiting"}, Part{850ms, "Positioning"}, Part{4s, "Calibration"},
                            Part{10s, "ReadyForLocalisation"}, Part{13s, "LocaliseCar"}}) {
        EXPECT_TRUE(run.run_for(part.of_the_day));
        EXPECT_EQ(run.state(), part.state);
        EXPECT_THAT(change("tracking", LifeChange::restart), IsEmpty());
        EXPECT_EQ(run.state(), "Waiting");
        EXPECT_TRUE(run.scene().is_on()) << "it has switched the camera on again";
        stop("panel");
        start("panel");
    }
    expect_follows_the_car_again();
}

TEST_F(Restarted, a_recognition_without_an_image_is_refused_with_the_reason) {
    EXPECT_TRUE(run.run_for(to_wait));
    stop("recognition");
    EXPECT_THAT(change("recognition", LifeChange::start),
                HasSubstr("\"image\" was never written; check that \"camera\" runs"));
    EXPECT_EQ(state_of("recognition"), ComponentState::stopped);
    EXPECT_EQ(run.state(), "Waiting");
}

TEST_F(Restarted, a_camera_stays_off_until_switched_on_and_its_user_names_the_line) {
    EXPECT_TRUE(run.run_for(to_wait));
    stop("camera");
    EXPECT_FALSE(run.scene().is_on());
    start("camera");
    EXPECT_FALSE(run.scene().is_on());
    EXPECT_FALSE(run.run_for(1s)) << "the panel moved it";
    EXPECT_THAT(std::string{run.instance().describe_stop().view()},
                HasSubstr(R"(run of state "Positioning" failed in line)"));
}

TEST_F(Restarted, a_camera_keeps_what_it_has_learned) {
    EXPECT_TRUE(run.run_for(in_between));
    const auto& camera = *run.instance().find<Camera>("camera");
    ASSERT_TRUE(camera.is_calibrated());
    const Lens learned = camera.lens.last();
    const double error_px = camera.calibration_error_px.last();
    ASSERT_NE(learned.focal_px, camera.nominal_focal_px.get());
    stop("camera");
    start("camera");
    EXPECT_TRUE(camera.is_calibrated());
    EXPECT_EQ(camera.lens.last().focal_px, learned.focal_px);
    EXPECT_EQ(camera.lens.last().k1, learned.k1);
    EXPECT_EQ(camera.calibration_error_px.last(), error_px);
}

} // namespace
} // namespace tappet::car_tracking

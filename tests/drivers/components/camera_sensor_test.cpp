// A camera as a component: images with their times, losses before the images after them, faults reported
// once.
#include "drivers/camera/sensor.hpp"
#include "drivers/camera/twin.hpp"
#include "tests/drivers/components/machine_rig.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tappet::test {
namespace {

using Eye = camera::Sensor<4, 2>;
using Shown = camera::Image<4, 2>;

struct Viewer {
    Input<Shown> image{};
    Input<std::int64_t> lost{}, flawed{}, repeated{}, late{};
    Input<bool> faulted{};
    int faults = 0, recoveries = 0;
    Bounded<Time, 64> arrivals{};

    void arrived(Time when) noexcept TAPPET_REALTIME { static_cast<void>(arrivals.push(when)); }
    void on_fault() noexcept TAPPET_REALTIME { ++faults; }
    void on_recovery() noexcept TAPPET_REALTIME { ++recoveries; }
    void work(const Cycle&) {}
    static constexpr auto interface() {
        return facets(
            input<&Viewer::image>("image", "", "shown"), input<&Viewer::lost>("lost", "", "so many"),
            input<&Viewer::flawed>("flawed", "", "so many"),
            input<&Viewer::repeated>("repeated", "", "so many"), input<&Viewer::late>("late", "", "so many"),
            input<&Viewer::faulted>("faulted", "", "nothing comes"),
            operation<&Viewer::arrived>("arrived", "an image came"),
            operation<&Viewer::on_fault>("on_fault", "the camera is gone"),
            operation<&Viewer::on_recovery>("on_recovery", "it is back"));
    }
};

// clang-format off
constexpr auto viewing = machine("viewing",
    components(
        component<Eye>("eye", device("lens"), set("stamp_delay", 3ms), set("silent_after", 100ms)),
        component<Viewer>("viewer")),
    activities(
        activity("eye", on_device("eye"), at_most(2, 10ms), runs("eye"), deadline(5ms), budget(100us)),
        activity("viewer", on_work(), not_real_time, runs("viewer"))),
    connections(
        data("eye.image",           "viewer.image"),
        data("eye.frames_lost",     "viewer.lost"),
        data("eye.frames_flawed",   "viewer.flawed"),
        data("eye.frames_repeated", "viewer.repeated"),
        data("eye.frames_late",     "viewer.late"),
        data("eye.faulted",         "viewer.faulted")),
    reactions(
        when("eye.arrived",          tell("viewer.arrived", queue(64))),
        when("eye.camera_fault",     tell("viewer.on_fault")),
        when("eye.camera_recovered", tell("viewer.on_recovery"))),
    behaviours());
// clang-format on

struct Viewing : MachineRig<viewing> {
    static constexpr Duration period = 10ms;

    Viewing() {
        twin.open({4, 2});
        configure<camera::Device>("lens", twin);
        viewer = instance.find<Viewer>("viewer");
    }
    Time carry(Time now) override {
        if (now >= next_image) {
            Shown image;
            image.pixels.fill({static_cast<std::uint8_t>(++images), 0, 0});
            if (is_showing) EXPECT_TRUE(twin.show(image.pixels, now));
            next_image += period;
        }
        twin.deliver();
        return next_image;
    }
    [[nodiscard]] int seen() { return viewer->image.get().at(1, 3).red; }

    camera::Twin twin{7};
    Viewer* viewer = nullptr;
    Time next_image{period};
    int images = 0;
    bool is_showing = true;
};

TEST_F(Viewing, writes_each_image_with_the_time_that_it_shows) {
    run_until(35ms);
    EXPECT_EQ(seen(), 3);
    EXPECT_EQ(viewer->image.stamp(), Time{27ms});
    EXPECT_EQ((std::vector<Time>{viewer->arrivals.begin(), viewer->arrivals.end()}),
              (std::vector<Time>{Time{7ms}, Time{17ms}, Time{27ms}}));
    EXPECT_FALSE(viewer->faulted.get());
}

TEST_F(Viewing, counts_what_it_does_not_write) {
    run_until(15ms);
    twin.faults() = {.lose_next = 1};
    run_until(35ms);
    EXPECT_EQ(viewer->lost.get(), 1);
    twin.faults() = {.flaw_next = 1};
    run_until(45ms);
    EXPECT_EQ(viewer->flawed.get(), 1);
    EXPECT_EQ(seen(), 3) << "the last good one";
    twin.faults() = {.repeat_next = 1};
    run_until(55ms);
    EXPECT_EQ(viewer->repeated.get(), 1);
    EXPECT_EQ(seen(), 5);
    twin.faults() = {.late_next = 1, .late_by = 4ms};
    instance.find<Eye>("eye")->oldest.set(3ms);
    run_until(65ms);
    EXPECT_EQ(viewer->late.get(), 1);
    run_until(75ms);
    EXPECT_EQ(seen(), 7);
    EXPECT_EQ(viewer->arrivals.size(), 4u) << "1, 3, 5 and 7";
    EXPECT_EQ(viewer->lost.get(), 1);
}

TEST_F(Viewing, reports_a_silent_camera_once_and_its_return) {
    run_until(15ms);
    is_showing = false;
    run_until(100ms);
    EXPECT_FALSE(viewer->faulted.get());
    run_until(120ms);
    EXPECT_TRUE(viewer->faulted.get());
    run_until(2s);
    EXPECT_EQ(viewer->faults, 1);
    EXPECT_LT(instance.engines()[0].statistics().cycles, 60u) << "it rests in between";
    is_showing = true;
    run_until(2s + 15ms);
    EXPECT_FALSE(viewer->faulted.get());
    EXPECT_EQ(viewer->recoveries, 1);
    EXPECT_EQ(viewer->lost.get(), 0) << "none was taken";
}

TEST_F(Viewing, reports_an_unplugged_camera_at_once) {
    run_until(15ms);
    twin.set_removed(true);
    run_until(25ms);
    EXPECT_TRUE(viewer->faulted.get());
    run_until(2s);
    EXPECT_EQ(viewer->faults, 1);
    twin.set_removed(false);
    run_until(2100ms);
    EXPECT_FALSE(viewer->faulted.get());
}

TEST_F(Viewing, drops_what_came_while_it_was_stopped) {
    run_until(25ms);
    change(0, LifeChange::stop);
    EXPECT_TRUE(viewer->faulted.get());
    run_until(105ms);
    EXPECT_EQ(viewer->faults, 1) << "images that nobody takes cannot be relied on";
    EXPECT_EQ(seen(), 2);
    change(0, LifeChange::start);
    run_until(109ms);
    EXPECT_EQ(seen(), 2) << "what came before the start is old";
    run_until(115ms);
    EXPECT_EQ(seen(), 11);
    EXPECT_EQ(viewer->lost.get(), 0);
    EXPECT_FALSE(viewer->faulted.get());
}

} // namespace
} // namespace tappet::test

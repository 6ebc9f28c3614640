// A level that commands a faster one: the row determines how the command, and its silence, arrive.
#include "tests/kernel/control/axis.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"

#include <vector>

namespace tappet {
namespace {

/// The outer level: a moving set point, and a Controller that passes its speed on.
struct Outer {
    Input<double> measured;
    Output<double> command;
    double at = 0.0;
    void start(const Cycle&) noexcept TAPPET_REALTIME { command.write(at); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { command.write(at += 0.04); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { command.write(0.0); }
    static constexpr auto interface() {
        return facets(input<&Outer::measured>("measured", "m", "the place"),
                      output<&Outer::command>("command", "m", "the next place"));
    }
};

/// The inner Generator, which records its commands.
struct Inner {
    Input<double> command;
    Output<double> target;
    std::vector<double> seen = std::vector<double>(1000);
    std::size_t count = 0;
    void start(const Cycle&) noexcept TAPPET_REALTIME { target.write(command.get()); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        const double now = command.get();
        if (count < seen.size()) seen[count++] = now;
        target.write(now);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(input<&Inner::command>("command", "m", "of the outer level"),
                      output<&Inner::target>("target", "m", "the next place"));
    }
};

template <RateTransition how>
constexpr auto cascade = machine(
    "cascade",
    components(component<Slide>("slide"), component<Encoder>("encoder"), component<Outer>("outer"),
               component<Inner>("inner"), component<Follower>("position", set("kp", 100.0)),
               component<Limiter>("limiter")),
    activities(activity("slow", every(4ms), budget(50us), runs("outer")),
               activity("fast", every(1ms, phase(100us)), budget(50us),
                        runs("slide", "encoder", "inner", "position", "limiter"))),
    connections(data("slide.place", "encoder.counted"),
                data("encoder.position", "outer.measured", stale_after(20ms), hold),
                data("outer.command", "inner.command", how, stale_after(20ms), stop_machine),
                data("inner.target", "position.target"), data("encoder.position", "position.measured"),
                data("limiter.sent", "position.sent", delayed), data("position.velocity", "limiter.velocity"),
                data("limiter.sent", "slide.driven", delayed)),
    reactions(), behaviours(),
    control(
        level("outside", controller("outer")),
        level("inside", sensor("encoder"), generator("inner"), controller("position"), effector("limiter")),
        loop("place", gain("position.kp"))));

template <RateTransition how>
struct Rig : VirtualRig {
    Inner* inner = instance.find<Inner>("inner");

    Rig() : VirtualRig{AtRunTime<cascade<how>, box>::machine()} { start(); }
    /// The largest change of the command between steps, after the start.
    double largest_step(Duration time) {
        EXPECT_TRUE(run(time));
        double largest = 0.0;
        for (std::size_t i = 20; i < inner->count; ++i)
            largest = std::max(largest, inner->seen[i] - inner->seen[i - 1]);
        return largest;
    }
};

TEST(Cascade, commands_in_steps_or_interpolates_as_its_row_says) {
    EXPECT_NEAR(Rig<in_steps>{}.largest_step(200ms), 0.04, 1e-9);
    EXPECT_NEAR(Rig<interpolated>{}.largest_step(200ms), 0.01, 1e-9);
    EXPECT_NEAR(Rig<extrapolated>{}.largest_step(200ms), 0.01, 1e-9);
}

TEST(Cascade, follows_its_row_when_the_outer_level_stops) {
    Rig<interpolated> rig;
    EXPECT_TRUE(rig.run(50ms));
    rig.change("outer", LifeChange::stop);
    rig.run(50ms);
    EXPECT_TRUE(rig.instance.stop_asked()) << "stop_machine";
}

} // namespace
} // namespace tappet

// An axis that is moved by the force it lacks, against a surface of 1e5 N/m: this gain would bounce for ever.
// refused: axis: loop "contact": gain times period is 0.662 at the longest period, but with 2 steps of delay the loop is stable only below 0.618; set position.kp below 2.943e-3, or shorten the delay
#include "kernel/machine/firmware.hpp"
#include "tests/kernel/control/axis.hpp"

using namespace tappet;

constexpr auto table = machine(
    "axis",
    components(component<Slide>("slide"), component<Encoder>("encoder"), component<Mover>("approach"),
               component<Follower>("position", set("kp", 3.15e-3)), component<Limiter>("limiter")),
    activities(activity("motion", every(2ms), budget(100us),
                        runs("slide", "encoder", "approach", "position", "limiter"))),
    connections(data("slide.place", "encoder.counted"), data("encoder.position", "approach.measured"),
                data("encoder.position", "position.measured"), data("approach.target", "position.target"),
                data("position.velocity", "limiter.velocity"), data("limiter.sent", "position.sent", delayed),
                data("limiter.sent", "slide.driven", delayed)),
    reactions(), behaviours(),
    control(
        level("axis", sensor("encoder"), generator("approach"), controller("position"), effector("limiter")),
        loop("contact", gain("position.kp"), stiffness(1.0e5), transport(4ms))));

template struct tappet::Firmware<table, tappet::box>;

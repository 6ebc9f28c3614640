// One axis for tests: a slide that integrates its rate, and the components of a control kernel around it.
#pragma once

#include "kernel/control/control.hpp"
#include "kernel/machine/accept.hpp"
#include "kernel/machine/worlds/virtual_world.hpp"

#include <algorithm>

namespace tappet {

inline constexpr double step_s = 1e-3; ///< period of the level

/// Sends the velocity within its limit and publishes the sent value.
struct Limiter {
    Input<double> velocity;
    Output<double> sent;
    double most = 2.0;
    std::uint64_t cycles = 0;
    void start(const Cycle&) noexcept TAPPET_REALTIME { sent.write(0.0); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        ++cycles;
        sent.write(std::clamp(velocity.get(), -most, most));
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { sent.write(0.0); }
    static constexpr auto interface() {
        return facets(input<&Limiter::velocity>("velocity", "m/s", "wanted"),
                      output<&Limiter::sent>("sent", "m/s", "to the drive, within the limit"));
    }
};

/// The plant: it has no role, like a driver.
struct Slide {
    Input<double> driven;
    Output<double> place;
    double at = 0.0;
    bool is_silent = false;
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        if (!is_silent) place.write(at);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (!is_silent) place.write(at += driven.get() * step_s);
    }
    static constexpr auto interface() {
        return facets(input<&Slide::driven>("driven", "m/s", "by the drive"),
                      output<&Slide::place>("place", "m", "of the slide"));
    }
};

struct Encoder {
    Input<double> counted;
    Output<double> position;
    void start(const Cycle&) noexcept TAPPET_REALTIME { position.write(counted.get()); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { position.write(counted.get()); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(input<&Encoder::counted>("counted", "m", "by the scale"),
                      output<&Encoder::position>("position", "m", "of the slide"));
    }
};

/// Set points from the present position of the slide: constant speed, or standstill.
struct Mover {
    Input<double> measured;
    Output<double> target;
    double speed = 0.0;
    double at = 0.0;
    bool is_mute = false;
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        at = measured.get();
        if (!is_mute) target.write(at);
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME { target.write(at += speed * step_s); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { target.write(at); }
    static constexpr auto interface() {
        return facets(input<&Mover::measured>("measured", "m", "where it begins"),
                      output<&Mover::target>("target", "m", "the next place"));
    }
};

/// Proportional; it starts with the velocity sent last, and the difference decays with the loop.
struct Follower {
    Input<double> target;
    Input<double> measured;
    Input<double> sent;
    Output<double> velocity;
    Property<double> kp{20.0};
    double bump = 0.0;
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        bump = sent.get() - kp.get() * (target.get() - measured.get());
        velocity.write(sent.get());
    }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        bump -= bump * 5.0 * step_s;
        velocity.write(kp.get() * (target.get() - measured.get()) + bump);
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(0.0); }
    static constexpr auto interface() {
        return facets(
            input<&Follower::target>("target", "m", "the next place"),
            input<&Follower::measured>("measured", "m", "the place"),
            input<&Follower::sent>("sent", "m/s", "in the step before"),
            output<&Follower::velocity>("velocity", "m/s", "wanted"),
            property<&Follower::kp>("kp", "1/s", "speed for each unit of the error", range(0.0, 900.0)));
    }
};

/// Sees the whole machine and changes it only by commands; it counts each cycle's events.
struct Watcher {
    Input<double> measured;
    Output<double> seen;
    CommandCall<const ScriptText&> run;
    std::uint32_t fallbacks = 0;
    std::uint32_t changes = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME { seen.write(measured.get()); }
    void fell_back() noexcept TAPPET_REALTIME { ++fallbacks; }
    void handed_over() noexcept TAPPET_REALTIME { ++changes; }
    static constexpr auto interface() {
        return facets(input<&Watcher::measured>("measured", "m", "the place"),
                      output<&Watcher::seen>("seen", "m", "the same"),
                      operation<&Watcher::fell_back>("fell_back", "counted"),
                      operation<&Watcher::handed_over>("handed_over", "counted"),
                      sends<&Watcher::run>("run", "a chain", optional));
    }
};

/// The table with another control section, and with other rows where a test needs them.
template <class... Extra>
constexpr auto axis_machine(const Extra&... extra) {
    return machine(
        "axis",
        components(component<ChainSwitch>("mode"), component<Slide>("slide"), component<Encoder>("encoder"),
                   component<Mover>("standing"), component<Mover>("jogging"), component<Follower>("position"),
                   component<Follower>("gentle", set("kp", 4.0)), component<Limiter>("limiter"),
                   component<Watcher>("watcher")),
        activities(activity("motion", every(1ms), budget(100us),
                            runs("mode", "slide", "encoder", "standing", "jogging", "position", "gentle",
                                 "limiter")),
                   activity("watch", every(5ms), budget(100us), runs("watcher"))),
        connections(
            data("slide.place", "encoder.counted"), data("encoder.position", "standing.measured"),
            data("encoder.position", "jogging.measured"), data("encoder.position", "position.measured"),
            data("encoder.position", "gentle.measured"), data("standing.target", "position.target"),
            data("jogging.target", "position.target"), data("standing.target", "gentle.target"),
            data("jogging.target", "gentle.target"), data("position.velocity", "limiter.velocity"),
            data("gentle.velocity", "limiter.velocity"), data("limiter.sent", "position.sent", delayed),
            data("limiter.sent", "gentle.sent", delayed), data("limiter.sent", "slide.driven", delayed),
            data("encoder.position", "watcher.measured")),
        reactions(when("mode.fell_back", tell("watcher.fell_back")),
                  when("mode.handed_over", tell("watcher.handed_over")), uses("watcher.run", "mode.run")),
        behaviours(), extra...);
}

inline constexpr auto axis_level =
    level("axis", sensor("encoder"), generator("standing"), generator("jogging"),
          controller("position", tracks("sent")), controller("gentle", tracks("sent")), effector("limiter"));
inline constexpr auto axis_modes =
    exclusive("mode", fallback("stand", "standing", "position"), chain("jog", "jogging", "position"),
              chain("softly", "jogging", "gentle"));

inline constexpr Board box{.name = "box", .memory_budget_bytes = 1 << 20};

} // namespace tappet

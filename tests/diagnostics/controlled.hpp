// Good machines with a control kernel, for rows that spoil them, and components for them.
#pragma once

#include "kernel/machine/table/compiled.hpp"
#include "kernel/statechart/rows.hpp"
#include "tests/diagnostics/rows/fault.hpp"
#include "tests/kernel/control/axis.hpp"

namespace tappet::diagnostics {

/// Knows two models of the axis, and the commands that it was given.
struct Observer {
    Input<double> measured;
    Input<double> sent;
    Output<double> speed;
    void start(const Cycle&) noexcept TAPPET_REALTIME { speed.write(0.0); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { speed.write(0.0); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { speed.write(measured.get() + sent.get()); }
    static constexpr auto interface() {
        return facets(input<&Observer::measured>("measured", "m", "the place", optional),
                      input<&Observer::sent>("sent", "m/s", "in the step before", optional),
                      output<&Observer::speed>("speed", "m/s", "estimated"));
    }
};

/// A Generator that declares neither its start values nor its final values.
struct Careless {
    Input<double> measured;
    Output<double> target;
    MethodCall<double()> ask;
    void step(const Cycle&) noexcept TAPPET_REALTIME { target.write(measured.get()); }
    static constexpr auto interface() {
        return facets(input<&Careless::measured>("measured", "m", "the place", optional),
                      output<&Careless::target>("target", "m", "the next place"),
                      calls<&Careless::ask>("ask", "how far", optional));
    }
};

/// A Controller that other components call.
struct Asked {
    Input<double> target;
    Output<double> velocity;
    double far() noexcept TAPPET_REALTIME { return target.get(); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(0.0); }
    void step(const Cycle&) noexcept TAPPET_REALTIME { velocity.write(target.get()); }
    static constexpr auto interface() {
        return facets(input<&Asked::target>("target", "m", "the next place"),
                      output<&Asked::velocity>("velocity", "m/s", "wanted"),
                      method<&Asked::far>("far", "how far"));
    }
};

struct Drive {
    static constexpr DeviceKind device_kind{.name = "test.drive", .is_opened_by_driver = true};
    Input<double> driven;
    Output<double> place;
    void step(const Cycle&) noexcept TAPPET_REALTIME { place.write(driven.get()); }
    static constexpr auto interface() {
        return facets(input<&Drive::driven>("driven", "m/s", "wanted", optional),
                      output<&Drive::place>("place", "m", "measured"));
    }
};

/// Has a gain, and no role.
struct Tuned {
    Property<double> kp;
    void step(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(property<&Tuned::kp>("kp", "1/s", "of nothing", range(0.0, 10.0)));
    }
};

inline constexpr auto moving =
    state_machine<Mover>("moving", states(state("on", initial), state("off", final)),
                         transitions(transition("on", "off", after(1s))));

/// Counts in whole numbers that another component reads.
struct Cycles {
    Output<std::int32_t> count;
    void step(const Cycle&) noexcept TAPPET_REALTIME { count.write(count.last() + 1); }
    static constexpr auto interface() { return facets(output<&Cycles::count>("count", "", "of cycles")); }
};
struct CyclesShown {
    Input<std::int32_t> count;
    void step(const Cycle&) noexcept TAPPET_REALTIME { static_cast<void>(count.get()); }
    static constexpr auto interface() { return facets(input<&CyclesShown::count>("count", "", "of cycles")); }
};

inline constexpr Board controlled_box{.name = "box", .memory_budget_bytes = 1 << 20};
inline constexpr Board wired_box{.name = "box",
                                 .memory_budget_bytes = 1 << 20,
                                 .devices = board_devices(board_device("drive0", "test.drive", "drive0"))};
inline constexpr Binding wired_binding = binding(wired("drive", "drive0"));

/// One level with three chains, of tests/kernel/control, with a stable loop.
inline Table axis() {
    static constexpr auto machine = axis_machine();
    Table table{machine.view(), controlled_box, unbound};
    table.is_controlled = true;
    table.control.levels = {axis_level};
    table.control.processes = {process("watcher")};
    table.control.exclusives = {axis_modes};
    table.components[5] = component<Follower>("position", set("kp", 200.0));
    table.control.loops = {loop("place", gain("position.kp"), transport(1ms))};
    return table;
}

/// Two levels: the outer one every 4 ms commands the inner one every 1 ms.
inline Table cascade() {
    static constexpr auto machine = tappet::machine(
        "cascade",
        components(component<Slide>("slide"), component<Encoder>("encoder"), component<Mover>("path"),
                   component<Follower>("outer"), component<Mover>("ramp"), component<Follower>("inner"),
                   component<Limiter>("limiter")),
        activities(
            activity("slow", every(4ms), budget(50us), runs("path", "outer")),
            activity("fast", every(1ms), budget(50us), runs("slide", "encoder", "ramp", "inner", "limiter"))),
        connections(data("slide.place", "encoder.counted"),
                    data("encoder.position", "path.measured", stale_after(20ms), stop_machine),
                    data("encoder.position", "outer.measured", stale_after(20ms), stop_machine),
                    data("path.target", "outer.target"),
                    data("limiter.sent", "outer.sent", stale_after(20ms), stop_machine),
                    data("outer.velocity", "ramp.measured", scaled(1.0), interpolated, stale_after(20ms),
                         stop_machine),
                    data("encoder.position", "inner.measured"), data("ramp.target", "inner.target"),
                    data("limiter.sent", "inner.sent", delayed), data("inner.velocity", "limiter.velocity"),
                    data("limiter.sent", "slide.driven", delayed)),
        reactions(), behaviours());
    Table table{machine.view(), controlled_box, unbound};
    table.is_controlled = true;
    table.control.levels = {level("outside", generator("path"), controller("outer", tracks("sent"))),
                            level("inside", sensor("encoder"), generator("ramp"),
                                  controller("inner", tracks("sent")), effector("limiter"))};
    return table;
}

/// Adds a component to the activity of the level.
inline void place(Table& m, const ComponentRow& row) { m.add(row, m.activities[0].name); }
inline void seat(Table& m, const RoleRow& role) {
    static_cast<void>(m.control.levels.back().roles.push(role));
}
/// Adds a component, and a row that leads to it.
inline void seat(Table& m, const ComponentRow& row, const RoleRow& role, const ConnectionRow& to) {
    place(m, row);
    m.add(to);
    seat(m, role);
}

} // namespace tappet::diagnostics

// The press with an interpreter: a gauge with every kind of facet for a line, and a panel that sends lines.
#pragma once

#include "kernel/services/interpreter/command_interpreter.hpp"
#include "tests/kernel/services/browsing/press_machine.hpp"

namespace tappet::press {

/// Every kind of facet that a line may use.
struct Gauge {
    Input<double> height;
    Output<double> force;
    BufferInput<std::int64_t> parts;
    BufferOutput<std::int64_t> marks;
    Event<> full;
    Property<double> target{10}, offset{0};
    Property<std::int16_t> steps{7};
    std::int64_t zeroed = 0;
    bool homed = true;

    void step(const Cycle&) noexcept TAPPET_REALTIME { force.write(height.get() / 4); }
    [[nodiscard]] bool all_homed() const noexcept TAPPET_REALTIME { return homed; }
    [[nodiscard]] double half(double of) const noexcept TAPPET_REALTIME { return of / 2; }
    std::int64_t zero() noexcept TAPPET_REALTIME { return ++zeroed; }
    bool lock(bool well) noexcept TAPPET_REALTIME { return well; }

    static constexpr auto interface() {
        return facets(
            input<&Gauge::height>("height", "mm", "of the table"),
            output<&Gauge::force>("force", "kN", "on it"),
            input<&Gauge::parts>("parts", "", "that come", optional),
            output<&Gauge::marks>("marks", "", "on parts"), event<&Gauge::full>("full", "too much"),
            property<&Gauge::target>("target", "kN", "wanted", range(0, 50)),
            property<&Gauge::offset>("offset", "kN", "of the cell; it has no range"),
            property<&Gauge::steps>("steps", "", "16 bits"),
            method<&Gauge::all_homed>("all_homed", "every axis is"),
            method<&Gauge::half>("half", "of a number"), method<&Gauge::zero>("zero", "counts"),
            method<&Gauge::lock>("lock", "says what it is told", for_people(Role::machine_operator)));
    }
};

/// Sends a line as a command.
struct Panel {
    CommandCall<CommandInterpreter::Line, CommandInterpreter::Line&> execute;
    CommandInterpreter::Line line{};
    bool wanted = false;

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (wanted && execute.send(line)) wanted = false;
    }
    static constexpr auto interface() { return facets(sends<&Panel::execute>("execute", "what was typed")); }
};

// clang-format off
inline constexpr auto line_table = machine("press",
    components(component<Ram>("ram"), component<Table>("table"), component<Gauge>("gauge"), component<Panel>("panel"), component<Panel>("panel_b"),
               component<BrowserService>("browser", set("log", false)), component<CommandInterpreter>("interpreter")),
    activities(
        activity("motion",  every(1ms), budget(50us), runs("ram", "gauge")),
        activity("slow",    every(10ms), budget(50us), runs("table", "panel", "panel_b")),
        activity("browser", every(20ms), not_real_time, stack(256 * 1024), runs("browser", "interpreter"))),
    connections(data("table.height", "ram.limit", stale_after(1s), hold), data("table.height", "gauge.height")),
    reactions(uses("panel.execute", "interpreter.execute"), uses("panel_b.execute", "interpreter.execute")), behaviours());
// clang-format on

} // namespace tappet::press

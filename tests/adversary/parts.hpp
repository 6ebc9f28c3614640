// Components that write to their outputs in every possible way: from a method, an operation, a command, a
// property's change, a step; and one with a long preparation.
#pragma once

#include "kernel/motion/filters.hpp"
#include "tests/adversary/maps.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace adversary {

/// Opens and closes on a call; a property holds it open.
struct Valve {
    Output<bool> on;
    Property<bool> held_open{false};
    Property<std::int64_t> opened{0}; ///< saved: how often it opened

    void stop(const Cycle&) noexcept TAPPET_REALTIME { on.write(false); }
    void changed() noexcept TAPPET_REALTIME {
        if (held_open.get() != on.last()) on.write(held_open.get());
    }
    void open() noexcept TAPPET_REALTIME { on.write(true); }
    void close() noexcept TAPPET_REALTIME { on.write(false); }
    bool turn(bool open) noexcept TAPPET_REALTIME {
        on.write(open);
        return true;
    }
    static constexpr auto interface() {
        return facets(
            output<&Valve::on>("on", "", "it is open"),
            property<&Valve::held_open>("held_open", "", "whatever is called"),
            property<&Valve::opened>("opened", "", "so often", range(0, 1'000'000)),
            method<&Valve::open>("open", "lets through", for_people(Role::machine_operator), any_thread),
            method<&Valve::close>("close", "lets nothing through", for_people(Role::machine_operator),
                                  any_thread),
            method<&Valve::turn>("turn", "open or not", any_thread));
    }
};

/// Turns as fast as a command or an event of another component says.
struct Pump {
    Output<double> speed, torque;
    Output<std::int64_t> on, spare;
    Property<double> most_torque{5.0};

    void start(const Cycle&) noexcept TAPPET_REALTIME { write(0); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { write(0); }
    void changed() noexcept TAPPET_REALTIME { torque.write(on.last() != 0 ? most_torque.get() : 0.0); }
    bool run(double at) noexcept TAPPET_REALTIME {
        if (!(at >= -1000 && at <= 1000)) return false;
        write(at);
        return true;
    }
    void nudge() noexcept TAPPET_REALTIME { write(speed.last() + 1); }

    static constexpr auto interface() {
        return facets(
            output<&Pump::speed>("speed", "rpm", "wanted"), output<&Pump::torque>("torque", "Nm", "at most"),
            output<&Pump::on>("on", "", "its power"),
            output<&Pump::spare>("spare", "", "no bit is left over"),
            property<&Pump::most_torque>("most_torque", "Nm", "while it turns", range(0, 100)),
            command<&Pump::run>("run", "as fast as that", for_people(Role::machine_operator, moves)),
            operation<&Pump::nudge>("nudge", "a bit faster"));
    }

private:
    void write(double at) noexcept TAPPET_REALTIME {
        speed.write(at);
        on.write(at != 0);
        torque.write(at != 0 ? most_torque.get() : 0.0);
        spare.write(0);
    }
};

/// Moves a gate by events, which its method emits.
struct Gate {
    Event<> lifts, falls;
    void stop(const Cycle&) noexcept TAPPET_REALTIME { falls.emit(); }
    void lift() noexcept TAPPET_REALTIME { lifts.emit(); }
    void drop() noexcept TAPPET_REALTIME { falls.emit(); }
    static constexpr auto interface() {
        return facets(event<&Gate::lifts>("lifts", "up"), event<&Gate::falls>("falls", "down"),
                      method<&Gate::lift>("lift", "up", for_people(Role::machine_operator, moves)),
                      operation<&Gate::drop>("drop", "down", for_people(Role::machine_operator, moves)));
    }
};

/// Heats to what it is set to, without a step.
struct Oven {
    Input<double> temperature;
    Output<double> power, fan, burner;
    Property<double> wanted{30.0};

    void start(const Cycle&) noexcept TAPPET_REALTIME { write(); }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        for (auto* each : {&power, &fan, &burner}) each->write(0);
    }
    void changed() noexcept TAPPET_REALTIME { write(); }
    void light() noexcept TAPPET_REALTIME { burner.write(1); }

    static constexpr auto interface() {
        return facets(input<&Oven::temperature>("temperature", "degC", "inside", optional),
                      output<&Oven::power>("power", "%", "of its coils"),
                      output<&Oven::fan>("fan", "rpm", "of its air"),
                      output<&Oven::burner>("burner", "", "1: it is lit"),
                      property<&Oven::wanted>("wanted", "%", "of its power", range(0, 100)),
                      operation<&Oven::light>("light", "the burner", for_people(Role::machine_operator)));
    }

private:
    void write() noexcept TAPPET_REALTIME {
        power.write(wanted.get());
        fan.write(wanted.get() > 0 ? 1500.0 : 0.0);
        burner.write(burner.last());
    }
};

/// Weighs its load, and has no mean before the first sample. A filter that passed a hundred different weights
/// unchanged filters nothing: then it reports that it has none.
struct Scale {
    Input<double> weight, flow;
    Output<double> filtered, mean, share;
    motion::Biquad filter = *motion::Biquad::low_pass(5.0, 10ms);
    double sum = 0, samples = 0, before = 0, unchanged = 0;

    void start(const Cycle&) noexcept TAPPET_REALTIME { tare(); }
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        mean.write(sum / samples);
        share.write(sum / samples);
        if (samples >= 1000) tare();
        double value = 0, into = 0;
        if (weight.read(value) != Flow::never_written) filtered.write(filter_weight(value));
        if (flow.read(into) != Flow::never_written) sum += std::clamp(filtered.last() + into, -1e3, 1e3);
        ++samples;
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME {
        tare();
        mean.write(sum / samples);
    }
    void tare() noexcept TAPPET_REALTIME { sum = samples = 0; }
    double filter_weight(double value) noexcept TAPPET_REALTIME {
        const double result = filter(value);
        if (std::exchange(before, value) != value) unchanged = result == value ? unchanged + 1 : 0;
        return unchanged < 100 ? result : std::numeric_limits<double>::quiet_NaN();
    }
    static constexpr auto interface() {
        return facets(input<&Scale::weight>("weight", "kg", "of the vessel"),
                      input<&Scale::flow>("flow", "kg/s", "into it", optional),
                      output<&Scale::filtered>("filtered", "kg", "what is weighed"),
                      output<&Scale::mean>("mean", "kg", "since it was tared"),
                      output<&Scale::share>("share", "kg", "the same, for who interpolates"),
                      operation<&Scale::tare>("tare", "from now on", for_people(Role::machine_operator)));
    }
};

/// Calls the valve, by a row of its own, whenever its level is low.
struct Doser {
    Input<double> height, share;
    Output<bool> lamp;
    MethodCall<void()> open, close;
    std::uint32_t cycles = 0;
    double has = 0;

    void step(const Cycle&) noexcept TAPPET_REALTIME {
        static_cast<void>(share.read(has));
        if (++cycles % 50 != 0) return;
        const bool opens = cycles % 100 == 0;
        const Answer<void> answer = opens ? open() : close();
        lamp.write(opens && answer.given());
    }
    bool dose(double) noexcept TAPPET_REALTIME { return true; }
    CommandProgress is_dosed(double weight) noexcept TAPPET_REALTIME {
        return has >= weight ? CommandProgress::done : CommandProgress::executing;
    }
    void stop(const Cycle&) noexcept TAPPET_REALTIME { lamp.write(false); }
    static constexpr auto interface() {
        return facets(input<&Doser::height>("height", "mm", "of what is dosed"),
                      input<&Doser::share>("share", "kg", "what there is", optional),
                      command<&Doser::dose, &Doser::is_dosed>("dose", "ends when so much is there",
                                                              for_people(Role::machine_operator)),
                      output<&Doser::lamp>("lamp", "", "it doses"), calls<&Doser::open>("open", "the valve"),
                      calls<&Doser::close>("close", "the valve"));
    }
};

/// Many things that happen all the time.
struct Beats {
    Event<> a, b, c, d, e, f, g, h, i, j;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        for (int n = 0; n < 2; ++n)
            for (Event<>* const each : {&a, &b, &c, &d, &e, &f, &g, &h, &i, &j}) each->emit();
    }
    static constexpr auto interface() {
        return facets(event<&Beats::a>("a", "a beat"), event<&Beats::b>("b", "a beat"),
                      event<&Beats::c>("c", "a beat"), event<&Beats::d>("d", "a beat"),
                      event<&Beats::e>("e", "a beat"), event<&Beats::f>("f", "a beat"),
                      event<&Beats::g>("g", "a beat"), event<&Beats::h>("h", "a beat"),
                      event<&Beats::i>("i", "a beat"), event<&Beats::j>("j", "a beat"));
    }
};

/// Room for a script, which may call the valve, the pump and the gate.
struct Recipe {
    Output<std::int64_t> steps;
    void step(const Cycle&) noexcept TAPPET_REALTIME { steps.write(steps.last() + 1); }
    static constexpr auto interface() { return facets(output<&Recipe::steps>("steps", "", "of the recipe")); }
};

} // namespace adversary

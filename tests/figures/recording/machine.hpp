// The machine whose recording is measured: ten components that write a hundred ports in each step.
#pragma once

#include "kernel/services/reporting/reporting.hpp"
#include "tests/figures/measure/world.hpp"

namespace tappet::figures {

/// Ten of the hundred ports. In each cycle all values change, or none.
struct Bank {
    static inline bool moves = true;
    double value = 0.0;
    Output<double> a, b, c, d, e, f, g, h, i, j;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (moves) value += 1.0;
        for (Output<double>* each : {&a, &b, &c, &d, &e, &f, &g, &h, &i, &j}) each->write(value);
    }
    static constexpr auto interface() {
        return facets(output<&Bank::a>("a", "", "counts"), output<&Bank::b>("b", "", "counts"),
                      output<&Bank::c>("c", "", "counts"), output<&Bank::d>("d", "", "counts"),
                      output<&Bank::e>("e", "", "counts"), output<&Bank::f>("f", "", "counts"),
                      output<&Bank::g>("g", "", "counts"), output<&Bank::h>("h", "", "counts"),
                      output<&Bank::i>("i", "", "counts"), output<&Bank::j>("j", "", "counts"));
    }
};

struct Window {
    static constexpr bool sees_machine = true;
    void work(const Cycle&) {}
    static constexpr auto interface() { return facets(); }
};

template <class... Extra>
constexpr auto machine_with(const Extra&... extra) {
    return machine("banks",
                   components(component<Bank>("0"), component<Bank>("1"), component<Bank>("2"),
                              component<Bank>("3"), component<Bank>("4"), component<Bank>("5"),
                              component<Bank>("6"), component<Bank>("7"), component<Bank>("8"),
                              component<Bank>("9"), component<Window>("window")),
                   activities(activity("motion", every(1ms), budget(100us),
                                       runs("0", "1", "2", "3", "4", "5", "6", "7", "8", "9")),
                              activity("background", every(20ms), not_real_time, runs("window"))),
                   connections(), reactions(), behaviours(), extra...);
}
template <class Option>
constexpr auto recorded_by(Option option) {
    return machine_with(reporting(report("0.*", option), report("1.*", option), report("2.*", option),
                                  report("3.*", option), report("4.*", option), report("5.*", option),
                                  report("6.*", option), report("7.*", option), report("8.*", option),
                                  report("9.*", option)));
}

inline constexpr auto silent = machine_with();
inline constexpr auto each_step = recorded_by(every(1));
inline constexpr auto each_tenth = recorded_by(every(10));
inline constexpr auto changes = recorded_by(on_change());

} // namespace tappet::figures

// A machine whose loop is more urgent than its wire, another machine, and a node that floods that wire. When
// the wire must be served within a shorter time than the loop's deadline, the priorities are wrong: a test
// for disturbance must find it there.
#pragma once

#include "drivers/system/station.hpp"

namespace tappet::flood {

inline constexpr Duration loop_period = 1ms, loop_deadline = 300us, loop_budget = 40us;

/// Follows the value of the other machine, and sends it back.
struct Loop {
    Input<double> followed{};
    Output<double> place{};
    void (*look)(const Cycle&) noexcept
        TAPPET_REALTIME = nullptr; ///< for the measuring test, at the end of a step

    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        place.write(followed.get() + 1);
        if (look != nullptr) look(cycle);
    }
    static constexpr auto interface() {
        return facets(input<&Loop::followed>("followed", "mm", "of the other one"),
                      output<&Loop::place>("place", "mm", "one more"));
    }
};

// clang-format off
inline constexpr auto table = machine("loop",
    components(component<Loop>("loop")),
    activities(activity("loop", every(loop_period), runs("loop"), deadline(loop_deadline), budget(loop_budget))),
    connections(), reactions(), behaviours());

template <Duration::rep served_ns, Duration::rep budget_ns>
inline constexpr auto two = tappet::system("two",
    nodes(node<table>("a"), node<table>("b")),
    wire("wire", bit_rate(500'000), beats(20ms), silent_after(70ms), served_within(Duration{served_ns}, budget(Duration{budget_ns}))),
    crossings(
        across(data("a.loop.place", "b.loop.followed", stale_after(60ms), hold), every(10ms), in_bits(24, 0.1)),
        across(data("b.loop.place", "a.loop.followed", stale_after(60ms), hold), every(10ms), in_bits(24, 0.1))),
    promises());
// clang-format on

/// The loop is more urgent than the wire.
inline constexpr auto& right = two<1'000'000, 60'000>;
/// Planted: the wire is more urgent than the loop.
inline constexpr auto& wrong = two<200'000, 10'000>;

/// A frame of the system with right protection, as its node would send it if it were out of control.
constexpr can::Frame frame_of(const WireFrame& as, std::uint64_t contents, std::uint8_t counter) {
    can::Frame frame{.id = as.id, .length = as.bytes};
    for (std::size_t i = 0; i < frame.length; ++i)
        frame.data[i] = static_cast<std::uint8_t>(contents >> 8 * i);
    static_cast<void>(protect(std::span{frame.data}.first(frame.length),
                              {.form = Protection::Form::id_both, .id = as.data_id}, counter));
    return frame;
}

} // namespace tappet::flood

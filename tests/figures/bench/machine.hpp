// The machine that answers on the bench: a frame with a frame, an edge with an edge, each in the activity of
// its device.
#pragma once

#include "drivers/can/bus.hpp"
#include "drivers/gpio/line_port.hpp"
#include "kernel/machine/table/board.hpp"
#include "kernel/machine/table/machine.hpp"

namespace tappet::figures::bench {

/// The identifiers and lines of the wires. The bare program has its own.
namespace wire {
inline constexpr std::uint32_t request = 0x101, answer = 0x201, bare_request = 0x102, bare_answer = 0x202;
inline constexpr unsigned in = 0, out = 1, bare_in = 2, bare_out = 3;
} // namespace wire

/// Answers with the number of the request.
struct Echo {
    Input<std::int64_t> asked;
    Output<std::int64_t> answer;
    void on_request() noexcept TAPPET_REALTIME {
        std::int64_t number = 0;
        static_cast<void>(asked.read(number));
        answer.write(number);
    }
    static constexpr auto interface() {
        return facets(input<&Echo::asked>("asked", "", "the number"),
                      output<&Echo::answer>("answer", "", "the same"),
                      operation<&Echo::on_request>("on_request", "answers"));
    }
};

/// The output follows the input.
struct Follower {
    Event<> on, off;
    void rises(Time) noexcept TAPPET_REALTIME { on.emit(); }
    void falls(Time) noexcept TAPPET_REALTIME { off.emit(); }
    static constexpr auto interface() {
        return facets(event<&Follower::on>("on", "the output is to be active"),
                      event<&Follower::off>("off", "the output is to be inactive"),
                      operation<&Follower::rises>("rises", "the input became active"),
                      operation<&Follower::falls>("falls", "the input became inactive"));
    }
};

// clang-format off
inline constexpr auto signals = can::signal_map(
    can::receive(can::standard(wire::request), "request", can::bytes(8), can::on_demand(1ms), can::signal("number", 0, 32)),
    can::transmit(can::standard(wire::answer), "answer", can::bytes(8), can::on_demand(2ms), can::signal("number", 0, 32)).safe_by_silence());
inline constexpr auto lines = gpio::line_map(gpio::sensor("in"), gpio::actuator("out", gpio::safe(false)));

inline constexpr auto table = machine("answering",
    components(component<can::Bus<signals>>("can", device("can")), component<Echo>("echo"),
               component<gpio::LinePort<lines>>("io", device("io")), component<Follower>("follower")),
    activities(
        activity("can", on_device("can"), at_most(4, 1ms), runs("can", "echo"),    deadline(800us), budget(100us)),
        activity("io",  on_device("io"),  at_most(4, 1ms), runs("io", "follower"), deadline(500us), budget(100us))),
    connections(data("can.request.number", "echo.asked", delayed), data("echo.answer", "can.answer.number")),
    reactions(
        when("can.request.received", call("echo.on_request")),
        when("io.in.rises",          call("follower.rises")),
        when("io.in.falls",          call("follower.falls")),
        when("follower.on",          call("io.out.set")),
        when("follower.off",         call("io.out.clear"))),
    behaviours());

inline constexpr Board board{
    .name = "bench", .world = "bench", .memory_budget_bytes = 4 * 1024 * 1024, .processors = 1, .highest_priority = 80,
    .devices = board_devices(board_device("can0", "can", "can0", bit_rate(1'000'000)), board_device("panel", "gpio", "/dev/panel", tappet::lines(32))),
    .only_warned = warn_only("clock-source", "cpu-governor", "heap-sealed")};

inline constexpr Binding bound = binding(wired("can", "can0"), wired("io", "panel", line("in", wire::in), line("out", wire::out)));
// clang-format on

} // namespace tappet::figures::bench

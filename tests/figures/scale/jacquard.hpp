// A jacquard head of 12288 hooks: each pick lifts a row of the pattern. Two machines drive it: over four CAN
// buses in frames of 64 hooks, and over register blocks that are written when they change.
#pragma once

#include "tests/figures/measure/candidates.hpp"

#include "kernel/component/buffer_port.hpp"
#include "kernel/machine/firmware.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tappet::figures {

namespace jacquard {

inline constexpr std::size_t hooks = 12288;
inline constexpr std::size_t hooks_of_frame = 64;
inline constexpr std::size_t words = hooks / hooks_of_frame;
inline constexpr std::size_t buses = 4;
inline constexpr std::size_t frames_of_bus = words / buses;
inline constexpr std::size_t picks_of_pattern = 128;

/// One bit for each hook: lifted or not.
struct HookRow {
    std::array<std::uint64_t, words> lifted{};
};
/// The woven picture, which repeats itself; drawn once, from a fixed seed.
const HookRow& row_of(std::uint32_t pick) noexcept TAPPET_REALTIME;

/// Eight bytes of data, as a CAN frame holds them.
struct Frame {
    std::uint32_t module = 0;
    std::uint32_t pick = 0;
    std::uint64_t lifted = 0;
};

/// Says with each of its cycles that the next pick begins.
struct Shaft {
    Event<std::uint32_t> pick;
    std::uint32_t picks = 0;
    void step(const Cycle&) noexcept TAPPET_REALTIME { pick(++picks); }
    static constexpr auto interface() {
        return facets(event<&Shaft::pick>("pick", "the shed opens: the number of the pick"));
    }
};

/// Sends the row of the pick in frames.
struct FrameHead {
    BufferOutput<Frame> bus_0, bus_1, bus_2, bus_3;
    std::uint32_t refused = 0;
    void select(std::uint32_t pick) noexcept TAPPET_REALTIME {
        const HookRow& row = row_of(pick);
        const std::array<BufferOutput<Frame>*, buses> bus{&bus_0, &bus_1, &bus_2, &bus_3};
        for (std::uint32_t module = 0; module < words; ++module)
            if (!bus[module / frames_of_bus]->push({module, pick, row.lifted[module]})) ++refused;
    }
    static constexpr auto interface() {
        return facets(output<&FrameHead::bus_0>("bus_0", "", "frames of 64 hooks"),
                      output<&FrameHead::bus_1>("bus_1", "", "frames of 64 hooks"),
                      output<&FrameHead::bus_2>("bus_2", "", "frames of 64 hooks"),
                      output<&FrameHead::bus_3>("bus_3", "", "frames of 64 hooks"),
                      operation<&FrameHead::select>("select", "sends the hooks of a pick"));
    }
};

/// What stands at the hooks' magnets in the end.
struct Hooks {
    HookRow row{};
    std::uint64_t written = 0; ///< blocks of 64
};

/// A bus of the hook modules; what leaves here is on the wire.
struct HookBus {
    BufferInput<Frame> frames;
    Hooks at_hooks;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        Frame frame;
        // As many as a pick has; a frame that comes meanwhile waits.
        for (std::size_t i = 0; i < frames_of_bus && frames.pop(frame); ++i) {
            at_hooks.row.lifted[frame.module] = frame.lifted;
            ++at_hooks.written;
        }
    }
    static constexpr auto interface() {
        return facets(input<&HookBus::frames>("frames", "", "to the hook modules"));
    }
};

/// Shows the row of the pick as one value.
struct RowHead {
    Output<HookRow> row;
    void select(std::uint32_t pick) noexcept TAPPET_REALTIME { row.write(row_of(pick)); }
    static constexpr auto interface() {
        return facets(output<&RowHead::row>("row", "", "all hooks of the pick"),
                      operation<&RowHead::select>("select", "shows the hooks of a pick"));
    }
};

/// Writes the register blocks that changed.
struct HookRegisters {
    Input<HookRow> row;
    HookRow seen{};
    Hooks at_hooks;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        if (row.read(seen) != Flow::fresh) return;
        for (std::size_t block = 0; block < words; ++block)
            if (seen.lifted[block] != at_hooks.row.lifted[block]) {
                at_hooks.row.lifted[block] = seen.lifted[block];
                ++at_hooks.written;
            }
    }
    static constexpr auto interface() {
        return facets(input<&HookRegisters::row>("row", "", "all hooks of the pick"));
    }
};

// clang-format off
inline constexpr auto over_can = machine("jacquard-can",
    components(
        component<Shaft>("shaft"),
        component<FrameHead>("head"),
        component<HookBus>("bus_0"),
        component<HookBus>("bus_1"),
        component<HookBus>("bus_2"),
        component<HookBus>("bus_3")),
    activities(
        activity("motion", every(50ms), budget(100us), runs("shaft")),
        activity("select", every(50ms), budget(1ms), runs("head")),
        activity("field",  every(50ms), budget(1ms), runs("bus_0", "bus_1", "bus_2", "bus_3"))),
    connections(
        buffer<frames_of_bus>("head.bus_0", "bus_0.frames"),
        buffer<frames_of_bus>("head.bus_1", "bus_1.frames"),
        buffer<frames_of_bus>("head.bus_2", "bus_2.frames"),
        buffer<frames_of_bus>("head.bus_3", "bus_3.frames")),
    reactions(
        when("shaft.pick", tell("head.select"))),
    behaviours());

inline constexpr auto over_registers = machine("jacquard-registers",
    components(
        component<Shaft>("shaft"),
        component<RowHead>("head"),
        component<HookRegisters>("field")),
    activities(
        activity("motion", every(50ms), budget(100us), runs("shaft")),
        activity("select", every(50ms), budget(1ms), runs("head")),
        activity("field",  every(50ms), budget(1ms), runs("field"))),
    connections(
        data("head.row", "field.row")),
    reactions(
        when("shaft.pick", tell("head.select"))),
    behaviours());
// clang-format on

inline constexpr Board board{.name = "figures", .world = "host", .memory_budget_bytes = 1'000'000};

} // namespace jacquard

std::vector<Group> jacquard_groups();

} // namespace tappet::figures

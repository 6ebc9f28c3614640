// Engine time for a pick of a jacquard head of 12288 hooks, beside the bare copies of the same 1536 bytes:
// each pick lifts a row of the pattern. Two machines drive it: over four CAN buses in frames of 64 hooks, and
// over register blocks that are written when they change.
#include "kernel/component/buffer_port.hpp"
#include "kernel/machine/accept.hpp"
#include "tests/figures/measure/world.hpp"
#include "tests/figures/scale/scale.hpp"

#include <array>
#include <cstdint>

namespace tappet::figures {

namespace {

constexpr std::size_t hooks = 12288;
constexpr std::size_t hooks_of_frame = 64;
constexpr std::size_t words = hooks / hooks_of_frame;
constexpr std::size_t buses = 4;
constexpr std::size_t frames_of_bus = words / buses;
constexpr std::size_t picks_of_pattern = 128;

/// One bit for each hook: lifted or not.
struct HookRow {
    std::array<std::uint64_t, words> lifted{};
};
/// The woven picture, which repeats itself; drawn once, from a fixed seed.
const HookRow& row_of(std::uint32_t pick) noexcept TAPPET_REALTIME {
    static constinit const auto pattern = [] {
        std::array<HookRow, picks_of_pattern> rows{};
        std::uint64_t state = 0x9e3779b97f4a7c15u;
        for (HookRow& row : rows)
            for (std::uint64_t& word : row.lifted) {
                state ^= state << 13, state ^= state >> 7, state ^= state << 17; // xorshift; Marsaglia 2003
                word = state;
            }
        return rows;
    }();
    return pattern[pick % picks_of_pattern];
}

/// Eight bytes of data, as a CAN frame holds them.
struct Frame {
    std::uint32_t module = 0;
    std::uint32_t pick = 0;
    std::uint64_t lifted = 0;
};

/// Announces the next pick in each of its cycles.
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

/// The final state of the hooks' magnets.
struct Hooks {
    HookRow row{};
    std::uint64_t written = 0; ///< blocks of 64
};

/// A bus of the hook modules; its output is on the wire.
struct HookBus {
    BufferInput<Frame> frames;
    Hooks at_hooks;
    void step(const Cycle&) noexcept TAPPET_REALTIME {
        Frame frame;
        // As many as a pick has; a frame that arrives meanwhile waits.
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
constexpr auto over_can = machine("jacquard-can",
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

constexpr auto over_registers = machine("jacquard-registers",
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

/// The shaft notifies the head, the head sends the row, the field writes it.
template <const auto& table>
void picks_of(std::size_t times) {
    static World loom{os::Clock::Kind::virtual_time, AtRunTime<table, figures_board>::machine()};
    for (std::size_t i = 0; i < times; ++i) loom.run_all();
}

std::uint32_t bare_pick = 0;
HookRow in_between;
HookRow at_hooks;
std::array<Frame, words> wire;

void two_copies(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        in_between = row_of(++bare_pick);
        keep(in_between);
        at_hooks = in_between;
        keep(at_hooks);
    }
}
void frames_by_hand(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        const HookRow& row = row_of(++bare_pick);
        for (std::uint32_t module = 0; module < words; ++module)
            wire[module] = {module, bare_pick, row.lifted[module]};
        keep(wire);
        for (const Frame& frame : wire) at_hooks.lifted[frame.module] = frame.lifted;
        keep(at_hooks);
    }
}

} // namespace

std::vector<Group> jacquard_groups() {
    return {{"scale.jacquard.can",
             "a pick of 12288 hooks in 192 CAN frames over four buses: shaft, head and field engines",
             "",
             1,
             {{"engines", Standing::ours, &picks_of<over_can>},
              {"two loops over an array of frames", Standing::floor, &frames_by_hand}}},
            {"scale.jacquard.registers",
             "a pick of 12288 hooks as 192 register blocks, written when they change: shaft, head and field",
             "",
             1,
             {{"engines", Standing::ours, &picks_of<over_registers>},
              {"two copies of the row", Standing::floor, &two_copies}}}};
}

} // namespace tappet::figures

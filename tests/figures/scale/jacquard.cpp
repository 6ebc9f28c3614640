// Engine time for a pick of the jacquard head, beside the bare copies of the same 1536 bytes.
#include "tests/figures/scale/jacquard.hpp"

#include "kernel/machine/accept.hpp"
#include "kernel/machine/instance/instance.hpp"

#include <cstdlib>
#include <iostream>

namespace tappet::figures {

namespace jacquard {

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

} // namespace jacquard

namespace {

using namespace jacquard;

template <const auto& table>
struct Loom {
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{AtRunTime<table, board>::machine(), clock};
    Loom() {
        if (const auto configured = instance.configure({}); !configured) {
            std::cerr << configured.error().view() << '\n';
            std::exit(2);
        }
        for (Engine& engine : instance.engines()) engine.start(clock.now());
    }
    /// The shaft tells the head, the head sends the row, the field writes it.
    void weave_a_pick() {
        for (Engine& engine : instance.engines()) {
            clock.advance_to(engine.next_wake());
            engine.run(false);
        }
    }
    static Loom& there() {
        static Loom loom;
        return loom;
    }
};

template <const auto& table>
void picks_of(std::size_t times) {
    auto& loom = Loom<table>::there();
    for (std::size_t i = 0; i < times; ++i) loom.weave_a_pick();
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

// Writes the source of one machine's firmware in a large system: the compile time and memory for the whole
// system's table, its frames, the analysis of its wire and that machine's end of it are a figure of the
// framework.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>

namespace tappet::diagnostics {

/// Each machine has ten rows across: it sends its neighbours six values, two events and a command, and knows
/// whether one of them is there.
struct SystemSize {
    std::size_t machines = 10;
    [[nodiscard]] std::size_t crossings() const { return 10 * machines; }
};

inline constexpr std::string_view machine_of_a_system = R"(
struct Cell {
    tappet::Output<double> level, force, speed, place, heat, flow;
    tappet::Input<double> next_level, next_force, next_speed, far_place, far_heat, far_flow;
    tappet::Input<bool> next_is_there;
    tappet::Event<std::int32_t> full, spare;
    tappet::CommandCall<std::int32_t> hold;
    std::int64_t heard = 0;
    void step(const tappet::Cycle&) noexcept TAPPET_REALTIME {
        level.write(next_level.get() + 1);
        force.write(next_force.get() + 1);
        speed.write(next_speed.get() + 1);
        place.write(far_place.get() + 1);
        heat.write(far_heat.get() + 1);
        flow.write(far_flow.get() + 1);
        if (level.last() > 100) full.emit(7);
        if (force.last() > 100) spare.emit(8);
        if (speed.last() > 100 && !tappet::in_flight(hold.state())) static_cast<void>(hold.send(9));
    }
    void take(std::int32_t number) noexcept TAPPET_REALTIME { heard += number; }
    bool held(std::int32_t number) noexcept TAPPET_REALTIME { return number > 0; }
    static constexpr auto interface() {
        using namespace tappet;
        return facets(output<&Cell::level>("level", "mm", "told"), output<&Cell::force>("force", "N", "told"),
                      output<&Cell::speed>("speed", "mm/s", "told"), output<&Cell::place>("place", "mm", "told"),
                      output<&Cell::heat>("heat", "K", "told"), output<&Cell::flow>("flow", "l/s", "told"),
                      input<&Cell::next_level>("next_level", "mm", "heard"),
                      input<&Cell::next_force>("next_force", "N", "heard"),
                      input<&Cell::next_speed>("next_speed", "mm/s", "heard"),
                      input<&Cell::far_place>("far_place", "mm", "heard"),
                      input<&Cell::far_heat>("far_heat", "K", "heard"),
                      input<&Cell::far_flow>("far_flow", "l/s", "heard"),
                      input<&Cell::next_is_there>("next_is_there", "", "the next one is heard"),
                      event<&Cell::full>("full", "for the next one"), event<&Cell::spare>("spare", "for the one behind it"),
                      sends<&Cell::hold>("hold", "the next one"), operation<&Cell::take>("take", "a number"),
                      command<&Cell::held>("held", "for a moment"));
    }
};
)";

inline void write_system(std::ostream& out, const SystemSize& size) {
    const auto end = [&](std::size_t n, const char* last) { return n + 1 == size.machines ? last : ",\n"; };
    const auto of = [&](std::size_t n, const char* facet) {
        return "\"m" + std::to_string(n % size.machines) + ".cell." + facet + "\"";
    };
    out << "#include \"board/host/board.hpp\"\n#include \"drivers/system/station.hpp\"\n#include "
           "\"kernel/machine/firmware.hpp\"\n"
        << machine_of_a_system
        << "\nusing namespace tappet;\nconstexpr auto cell = machine(\"cell\",\n"
           "    components(component<Cell>(\"cell\")),\n"
           "    activities(activity(\"cell\", every(10ms), runs(\"cell\"), budget(50us))),\n"
           "    connections(), reactions(), behaviours());\n"
           "constexpr auto plant = tappet::system(\"plant\",\n    nodes(\n";
    for (std::size_t n = 0; n < size.machines; ++n)
        out << "        node<cell>(\"m" << n << "\")" << end(n, "),\n");
    out << "    wire(\"wire\", bit_rate(500'000), beats(50ms), silent_after(260ms), served_within(1ms, "
           "budget(50us))),\n    crossings(\n";
    for (std::size_t n = 0; n < size.machines; ++n) {
        const auto tell = [&](const char* from, std::size_t to, const char* input) {
            out << "        across(data(" << of(n, from) << ", " << of(to, input)
                << ", stale_after(200ms), hold), every(50ms), in_bits(12, 0.5)),\n";
        };
        tell("level", n + 1, "next_level");
        tell("force", n + 1, "next_force");
        tell("speed", n + 1, "next_speed");
        tell("place", n + 2, "far_place");
        tell("heat", n + 2, "far_heat");
        tell("flow", n + 2, "far_flow");
        out << "        across(when(" << of(n, "full") << ", tell(" << of(n + 1, "take")
            << ")), at_most(1, 500ms), within(200ms)),\n"
            << "        across(when(" << of(n, "spare") << ", tell(" << of(n + 2, "take")
            << ")), at_most(1, 500ms), within(200ms)),\n"
            << "        across(uses(" << of(n, "hold") << ", " << of(n + 1, "held")
            << "), at_most(1, 500ms), within(200ms)),\n"
            << "        presence(\"m" << (n + 1) % size.machines << "\", " << of(n, "next_is_there") << ")"
            << end(n, "),\n");
    }
    out << "    promises(\n        reaction(" << of(0, "full") << ", " << of(1, "take")
        << ", within(100ms)),\n        stops(\"m1\", " << of(0, "next_is_there") << ", within(400ms))));\n"
        << "constexpr auto accepted_table = station<plant, \"m0\", cell>;\n"
        << "AcceptedMachine accepted() { return Firmware<accepted_table, board::host>::machine(); }\n";
}

} // namespace tappet::diagnostics

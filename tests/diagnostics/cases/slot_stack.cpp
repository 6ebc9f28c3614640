// Whoever compiles what is loaded into the slot has too little stack for it.
// refused: loom: slot of "shaft": scripts are compiled in activity "hall", whose stack of 65536 bytes is under 229376; enlarge its stack(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Observer {
    static constexpr bool sees_machine = true;
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

constexpr auto table = loom(
    components(component<Encoder>("encoder", device("main_encoder")), component<Shaft>("shaft"),
               component<Tension>("tension"), component<Weft>("weft"),
               component<Climate>("climate", device("hall")), component<Lamps>("lamps", device("panel")),
               component<Observer>("browser")),
    activities(
        activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                 runs("encoder")),
        activity("motion", every(1ms), budget(120us), runs("shaft", "tension")),
        activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us), runs("weft", "lamps")),
        activity("hall", every(250ms), not_real_time, runs("climate", "browser"))),
    good_connections, good_reactions,
    behaviours(behaviour("weft", weft_cycle), behaviour("shaft", slot(nodes(10), data_bytes(64), depth(4)))));
template struct tappet::Firmware<table, good_board>;

// A component that sees the machine runs in a real-time activity.
// refused: loom: component "browser" sees the machine, but its activity "logic" is real-time; run it in an activity that is not_real_time
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Observer {
    static constexpr bool sees_machine = true;
    static constexpr auto interface() { return std::array<Facet, 0>{}; }
};

constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")), component<Shaft>("shaft"),
                    component<Tension>("tension"), component<Weft>("weft"),
                    component<Climate>("climate", device("hall")), component<Lamps>("lamps", device("panel")),
                    component<Observer>("browser")),
         activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                             runs("encoder")),
                    activity("motion", every(1ms), budget(120us), runs("shaft", "tension")),
                    activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us),
                             runs("weft", "lamps", "browser")),
                    activity("hall", every(250ms), not_real_time, runs("climate"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

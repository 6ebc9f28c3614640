// Two components drive one device.
// refused: loom: component "spare" drives device "main_encoder", as component "encoder" does; a device has one driver
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")), component<Shaft>("shaft"),
                    component<Tension>("tension"), component<Weft>("weft"),
                    component<Climate>("climate", device("hall")), component<Lamps>("lamps", device("panel")),
                    component<Encoder>("spare", device("main_encoder"))),
         activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                             runs("encoder", "spare")),
                    activity("motion", every(1ms), budget(120us), runs("shaft", "tension")),
                    activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us),
                             runs("weft", "lamps")),
                    activity("hall", every(250ms), not_real_time, runs("climate"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

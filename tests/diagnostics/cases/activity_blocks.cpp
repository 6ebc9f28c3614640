// A real-time activity runs a component that may block.
// refused: loom: activity "hall" is real-time but component "climate" may block (it has work()); run it in an activity that is not_real_time
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components,
         activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                             runs("encoder")),
                    activity("motion", every(1ms), budget(120us), runs("shaft", "tension")),
                    activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us),
                             runs("weft", "lamps")),
                    activity("hall", every(250ms), budget(1ms), runs("climate"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

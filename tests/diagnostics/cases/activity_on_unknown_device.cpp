// An activity waits for the device of a component that is misspelt.
// refused: loom: activity "field": there is no component "encodre"; did you mean "encoder"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components,
         activities(activity("field", on_device("encodre"), at_most(1, 1ms), deadline(300us), budget(30us),
                             runs("encoder")),
                    activity("motion", every(1ms), budget(120us), runs("shaft", "tension")),
                    activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us),
                             runs("weft", "lamps")),
                    activity("hall", every(250ms), not_real_time, runs("climate"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

// The budgets of the more urgent activities leave too little time.
// refused: loom: activity "logic" is not schedulable on processor 1 of board "bench": its worst response is 350 us, its deadline 340 us; lower the budget of it or of a more urgent activity, lengthen its deadline, or place it elsewhere
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components,
         activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                             runs("encoder")),
                    activity("motion", every(1ms), budget(120us), runs("shaft", "tension")),
                    activity("logic", on_work(), at_most(4, 10ms), deadline(340us), budget(80us),
                             runs("weft", "lamps")),
                    activity("hall", every(250ms), not_real_time, runs("climate"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

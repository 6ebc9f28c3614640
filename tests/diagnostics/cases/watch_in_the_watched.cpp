// A watchdog runs in the activity that it watches.
// refused: loom: component "dog" runs in activity "motion", which it watches: when that is silent, so is it; run it in another one
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table =
    loom(components_with(component<Watchdog>("dog", watches("motion"), set("limit", 20ms))),
         activities(good_activities.rows[0],
                    activity("motion", every(1ms), budget(120us), runs("shaft", "tension", "dog")),
                    good_activities.rows[2], good_activities.rows[3]),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

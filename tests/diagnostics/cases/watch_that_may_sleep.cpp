// A watchdog runs in an activity that may sleep for ever.
// refused: loom: component "dog" looks once in each cycle, but activity "kennel" may sleep for ever; run it in one that is every(...)
#include "tests/diagnostics/guarded.hpp"

using namespace small;

constexpr auto table =
    loom(components_with(component<Watchdog>("dog", watches("motion"), set("limit", 20ms))),
         activities(good_activities.rows[0], good_activities.rows[1], good_activities.rows[2],
                    good_activities.rows[3], activity("kennel", on_work(), not_real_time, runs("dog"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

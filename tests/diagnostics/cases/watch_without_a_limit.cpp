// A watchdog watches an activity and does not say for how long it may be silent.
// refused: loom: component "dog" watches activity "motion" without a limit; add set("limit", ...) longer than its period
#include "tests/diagnostics/small_machine.hpp"

#include "kernel/services/time/watchdog.hpp"

using namespace small;

constexpr auto table =
    loom(components(good_components.rows[0], good_components.rows[1], good_components.rows[2],
                    good_components.rows[3], good_components.rows[4], good_components.rows[5],
                    component<Watchdog>("dog", watches("motion"))),
         activities(good_activities.rows[0], good_activities.rows[1], good_activities.rows[2],
                    good_activities.rows[3], activity("kennel", every(10ms), not_real_time, runs("dog"))),
         good_connections, good_reactions, good_behaviours);

template struct tappet::Firmware<table, good_board, good_binding>;

// A watchdog watches an activity and does not say for how long it may be silent.
// refused: loom: component "dog" watches activity "motion" without a limit; add set("limit", ...) longer than its period
#include "tests/diagnostics/small_machine.hpp"

#include "kernel/services/time/watchdog.hpp"

using namespace small;

constexpr auto table = loom_with(component<Watchdog>("dog", watches("motion")),
                                 activity("kennel", every(10ms), not_real_time, runs("dog")));

template struct tappet::Firmware<table, good_board, good_binding>;

// The small machine with a watchdog: what the cases of watches(...) vary.
#pragma once

#include "kernel/services/time/timed_event.hpp"
#include "kernel/services/time/watchdog.hpp"
#include "tests/diagnostics/small_machine.hpp"

namespace small {

template <class Dog>
constexpr auto components_with(const Dog& dog) {
    return components(good_components.rows[0], good_components.rows[1], good_components.rows[2],
                      good_components.rows[3], good_components.rows[4], good_components.rows[5], dog);
}

inline constexpr auto dog_in_the_kennel =
    activities(good_activities.rows[0], good_activities.rows[1], good_activities.rows[2],
               good_activities.rows[3], activity("kennel", every(10ms), not_real_time, runs("dog")));

} // namespace small

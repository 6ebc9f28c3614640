// A buffer's values have no age.
// refused: loom: connection "encoder.samples" -> "shaft.samples": values in a buffer have no age and no initial value; remove what says so from the row
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities,
                            connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                                        data("shaft.speed", "tension.speed"),
                                        buffer<4>("encoder.samples", "shaft.samples", stale_after(4ms))),
                            good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

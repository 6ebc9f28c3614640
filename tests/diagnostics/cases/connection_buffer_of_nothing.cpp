// A buffer without room.
// refused: loom: connection "encoder.samples" -> "shaft.samples" holds no value; write buffer<n> with n of at least 1
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                     data("shaft.speed", "tension.speed"), buffer<0>("encoder.samples", "shaft.samples")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

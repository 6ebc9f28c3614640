// data(...) names a buffered port.
// refused: loom: connection "encoder.samples" -> "shaft.samples": "encoder.samples" is a buffered output, not an output; write buffer<n>(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities,
         connections(data("encoder.angle", "shaft.measured", stale_after(4ms), hold),
                     data("shaft.speed", "tension.speed"), data("encoder.samples", "shaft.samples")),
         good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

// A row says what a stale value means but not when it is stale.
// refused: loom: connection "encoder.angle" -> "shaft.measured" says what a stale value means but not when it is stale; add stale_after(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(
    good_components, good_activities,
    connections(data("encoder.angle", "shaft.measured", stop_machine), data("shaft.speed", "tension.speed")),
    good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

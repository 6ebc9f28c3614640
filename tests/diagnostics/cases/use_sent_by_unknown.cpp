// A command sent by a component that is not there.
// refused: mill: use "desk.close" -> "press.close": in sent_by(...), there is no component "spar"; did you mean "spare"?
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table = pressing(
    reactions(spare_close, spare_force, desk_force, uses("desk.close", "press.close", sent_by("spar"))));
template struct tappet::Firmware<table, mill_board>;

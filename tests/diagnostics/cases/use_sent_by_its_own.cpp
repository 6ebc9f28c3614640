// A command sent by the component that has it.
// refused: mill: use "desk.close" -> "press.close": sent_by(...) names the component whose command it is; remove it
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table = pressing(
    reactions(spare_close, spare_force, desk_force, uses("desk.close", "press.close", sent_by("desk"))));
template struct tappet::Firmware<table, mill_board>;

// A use from the command to the call.
// refused: mill: use "press.close" -> "desk.close" runs from a command to a command call; exchange the two
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_force, uses("press.close", "desk.close")));
template struct tappet::Firmware<table, mill_board>;

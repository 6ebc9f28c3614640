// A use by a call that is not there.
// refused: mill: use "desk.closs" -> "press.close": component "desk" has no command call "closs"; did you mean "close"?
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_force, uses("desk.closs", "press.close")));
template struct tappet::Firmware<table, mill_board>;

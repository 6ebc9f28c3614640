// A use of a command that is not there.
// refused: mill: use "desk.close" -> "press.clos": component "press" has no command "clos"; did you mean "close"?
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_force, uses("desk.close", "press.clos")));
template struct tappet::Firmware<table, mill_board>;

// A use of another call.
// refused: mill: use "desk.force" -> "spare.force": "spare.force" is a method call, not a method or a command; name one of these second
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_close, uses("desk.force", "spare.force")));
template struct tappet::Firmware<table, mill_board>;

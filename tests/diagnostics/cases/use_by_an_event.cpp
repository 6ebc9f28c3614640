// A use by an event.
// refused: mill: use "desk.tired" -> "press.force": "desk.tired" is an event, not a method call or a command call; name one of these first
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_close, desk_force, uses("desk.tired", "press.force")));
template struct tappet::Firmware<table, mill_board>;

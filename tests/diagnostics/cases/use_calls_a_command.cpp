// A method call that is to reach a command.
// refused: mill: use "desk.force" -> "press.open": a command is sent, not called; make "desk.force" a CommandCall
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_close, uses("desk.force", "press.open")));
template struct tappet::Firmware<table, mill_board>;

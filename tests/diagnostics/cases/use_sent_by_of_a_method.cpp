// A method that is to be sent by another.
// refused: mill: use "desk.force" -> "press.force": sent_by("spare") is of commands; remove it
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table = pressing(
    reactions(spare_close, spare_force, desk_close, uses("desk.force", "press.force", sent_by("spare"))));
template struct tappet::Firmware<table, mill_board>;

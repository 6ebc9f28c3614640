// A use of a method that is not there.
// refused: mill: use "desk.force" -> "press.forse": component "press" has no method "forse"; did you mean "force"?
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_close, uses("desk.force", "press.forse")));
template struct tappet::Firmware<table, mill_board>;

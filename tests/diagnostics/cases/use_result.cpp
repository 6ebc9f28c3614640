// A method call whose result is not that of the method.
// refused: mill: use "desk.force" -> "press.strokes": the call and the method have different results; give both the same
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_close, uses("desk.force", "press.strokes")));
template struct tappet::Firmware<table, mill_board>;

// A use of a component that is not there.
// refused: mill: use "desk.force" -> "pres.force": there is no component "pres"; did you mean "press"?
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_close, uses("desk.force", "pres.force")));
template struct tappet::Firmware<table, mill_board>;

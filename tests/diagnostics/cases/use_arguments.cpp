// A command call whose arguments are not those of the command.
// refused: mill: use "desk.close" -> "press.open": the call gives (double, tappet::Result<int>) but the command takes (int); give both the same arguments
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_force, uses("desk.close", "press.open")));
template struct tappet::Firmware<table, mill_board>;

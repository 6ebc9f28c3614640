// A use of an operation, which is for events.
// refused: mill: use "desk.force" -> "press.oil": "press.oil" is an operation, which only an event runs; declare it a method or a command
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_close, uses("desk.force", "press.oil")));
template struct tappet::Firmware<table, mill_board>;

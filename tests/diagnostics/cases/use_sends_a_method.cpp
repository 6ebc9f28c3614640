// A command call that is to reach a method.
// refused: mill: use "desk.close" -> "press.force": a method is called, not sent; make "desk.close" a MethodCall
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table =
    pressing(reactions(spare_close, spare_force, desk_force, uses("desk.close", "press.force")));
template struct tappet::Firmware<table, mill_board>;

// A use that stands twice.
// refused: mill: use "desk.force" -> "press.force" stands in reactions(...) twice (rows 4 and 5); remove one
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table = pressing(reactions(spare_close, spare_force, desk_close, desk_force, desk_force));
template struct tappet::Firmware<table, mill_board>;

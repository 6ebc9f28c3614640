// A command call that no row connects.
// refused: mill: component "desk": no row says what its command call "close" reaches; add uses("desk.close", "...") to reactions(...), or declare it optional
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table = pressing(reactions(spare_close, spare_force, desk_force));
template struct tappet::Firmware<table, mill_board>;

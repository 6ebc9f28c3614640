// A method call that no row connects.
// refused: mill: component "spare": no row says what its method call "force" reaches; add uses("spare.force", "...") to reactions(...), or declare it optional
#include "tests/diagnostics/peers.hpp"

using namespace small;

constexpr auto table = pressing(reactions(spare_close, desk_close, desk_force));
template struct tappet::Firmware<table, mill_board>;

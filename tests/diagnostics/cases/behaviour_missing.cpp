// A component that needs a behaviour has none.
// refused: loom: component "weft": no behaviour drives it; add behaviour("weft", ...) to behaviours(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions, behaviours());
template struct tappet::Firmware<table, good_board>;

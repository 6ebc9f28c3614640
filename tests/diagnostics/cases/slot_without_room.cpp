// A slot reserves nothing.
// refused: loom: slot of "shaft" reserves no nodes, data or depth; state all three
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("weft", weft_cycle), behaviour("shaft", Slot{})));
template struct tappet::Firmware<table, good_board>;

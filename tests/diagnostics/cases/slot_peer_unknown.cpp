// A slot's reach names a component that is misspelt.
// refused: loom: slot of "shaft": among its peers, there is no component "wefft"; did you mean "weft"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(
    good_components, good_activities, good_connections, good_reactions,
    behaviours(behaviour("weft", weft_cycle),
               behaviour("shaft", Slot{.nodes = 10, .data_bytes = 64, .depth = 4, .peers = names("wefft")})));
template struct tappet::Firmware<table, good_board>;

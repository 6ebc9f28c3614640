// A slot's reach names an operation that is misspelt.
// refused: loom: slot of "shaft": among its operations, component "weft" has no operation "relase"; did you mean "release"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities, good_connections, good_reactions,
         behaviours(
             behaviour("weft", weft_cycle),
             behaviour("shaft",
                       Slot{.nodes = 10, .data_bytes = 64, .depth = 4, .operations = names("weft.relase")})));
template struct tappet::Firmware<table, good_board>;

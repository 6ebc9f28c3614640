// A slot's reach names an event that is none.
// refused: loom: slot of "shaft": among its events, "weft.release" is an operation, not an event; name an event
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(
    good_components, good_activities, good_connections, good_reactions,
    behaviours(behaviour("weft", weft_cycle),
               behaviour("shaft",
                         Slot{.nodes = 10, .data_bytes = 64, .depth = 4, .events = names("weft.release")})));
template struct tappet::Firmware<table, good_board>;

// The operation wants an argument that the event does not carry.
// refused: loom: reaction "weft.broken" -> "shaft.on_index": the event carries () but the operation takes (double); give both the same arguments
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections,
                            reactions(when("weft.broken", tell("shaft.on_index"))), good_behaviours);
template struct tappet::Firmware<table, good_board>;

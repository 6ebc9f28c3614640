// The event's arguments are not the operation's.
// refused: loom: reaction "encoder.index" -> "shaft.clear": the event carries (double) but the operation takes (); give both the same arguments
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities, good_connections,
         reactions(when("encoder.index", tell("shaft.on_index")), when("encoder.index", tell("shaft.clear"))),
         good_behaviours);
template struct tappet::Firmware<table, good_board, good_binding>;

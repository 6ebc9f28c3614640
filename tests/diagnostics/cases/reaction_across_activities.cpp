// A synchronous call into another activity, of an operation that is not any_thread.
// refused: loom: reaction "weft.broken" -> "shaft.clear": a synchronous call would run "shaft.clear" of activity "motion" in activity "logic"; use tell(...), or declare the operation any_thread if it is safe there
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components, good_activities, good_connections,
         reactions(when("encoder.index", tell("shaft.on_index")), when("weft.broken", call("shaft.clear"))),
         good_behaviours);
template struct tappet::Firmware<table, good_board>;

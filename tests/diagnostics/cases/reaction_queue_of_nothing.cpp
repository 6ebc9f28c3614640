// A reaction whose queue holds nothing.
// refused: loom: reaction "weft.broken" -> "shaft.clear": no emission may wait; write queue(n) with n of at least 1
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections,
                            reactions(when("encoder.index", tell("shaft.on_index")),
                                      when("weft.broken", tell("shaft.clear", queue(0)))),
                            good_behaviours);
template struct tappet::Firmware<table, good_board>;

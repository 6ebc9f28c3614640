// A required operation is named by no reaction.
// refused: loom: component "shaft": no reaction names its required operation "on_index"; add when("...", tell("shaft.on_index"))
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections,
                            reactions(when("shaft.window", call("tension.pre_tension"))), good_behaviours);
template struct tappet::Firmware<table, good_board>;

// A behaviour names a component that is misspelt.
// refused: loom: behaviour of "wefd": there is no component "wefd"; did you mean "weft"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(good_components, good_activities, good_connections, good_reactions,
                            behaviours(behaviour("wefd", weft_cycle)));
template struct tappet::Firmware<table, good_board>;

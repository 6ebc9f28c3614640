// A list has elements of another type.
// refused: loom: component "shaft" sets property "offsets" to a list of 2, but it is a list, each a number; write set<values>(...) with an array of such, constant at namespace scope
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr std::array<bool, 2> values{true, false};
constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")),
                    component<Shaft>("shaft", set<values>("offsets")), component<Tension>("tension"),
                    component<Weft>("weft"), component<Climate>("climate", device("hall")),
                    component<Lamps>("lamps", device("panel"))),
         good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board, good_binding>;

// One element of a list is outside the range.
// refused: loom: component "shaft" sets property "offsets" to -2, which is under its least value -1; set a value in its range, or widen range(...) in the interface of small::Shaft
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr std::array<double, 2> values{0.5, -2.0};
constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")),
                    component<Shaft>("shaft", set<values>("offsets")), component<Tension>("tension"),
                    component<Weft>("weft"), component<Climate>("climate", device("hall")),
                    component<Lamps>("lamps", device("panel"))),
         good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

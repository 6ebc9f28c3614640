// A list has more elements than its property has room for.
// refused: loom: component "shaft" sets property "offsets" to a list of 4, but it has at most 3; give it so many
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr std::array<double, 4> values{0.5, 0.5, 0.5, 0.5};
constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")),
                    component<Shaft>("shaft", set<values>("offsets")), component<Tension>("tension"),
                    component<Weft>("weft"), component<Climate>("climate", device("hall")),
                    component<Lamps>("lamps", device("panel"))),
         good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

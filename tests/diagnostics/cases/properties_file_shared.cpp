// Two components have one properties file.
// refused: loom: component "tension" has the properties file "shaft.cpf" of component "shaft"; each needs a file of its own
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(components(component<Encoder>("encoder", device("main_encoder")),
                                       component<Shaft>("shaft", properties_file("shaft.cpf")),
                                       component<Tension>("tension", properties_file("shaft.cpf")),
                                       component<Weft>("weft"), component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel"))),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

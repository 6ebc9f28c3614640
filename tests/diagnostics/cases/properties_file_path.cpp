// A properties file is given with a path.
// refused: loom: component "shaft": its properties file "/etc/shaft.cpf" is not the plain name of a file; the board's properties_directory says where it lies
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(components(component<Encoder>("encoder", device("main_encoder")),
                                       component<Shaft>("shaft", properties_file("/etc/shaft.cpf")),
                                       component<Tension>("tension"), component<Weft>("weft"),
                                       component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel"))),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

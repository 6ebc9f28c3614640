// A component without properties has a properties file.
// refused: loom: component "weft" has no properties but a properties file "weft.cpf"; remove properties_file(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = loom(
    components(component<Encoder>("encoder", device("main_encoder")), component<Shaft>("shaft"),
               component<Tension>("tension"), component<Weft>("weft", properties_file("weft.cpf")),
               component<Climate>("climate", device("hall")), component<Lamps>("lamps", device("panel"))),
    good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

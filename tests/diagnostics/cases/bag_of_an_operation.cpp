// A bag holds what is no property.
// refused: loom: component "tension": its bag "deeds" holds "deeds.stop", which is an operation; a bag holds properties and bags
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Named : Tension {
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      output<&Tension::torque>("torque", "N m", "of the let-off"),
                      operation<&Tension::pre_tension>("pre_tension", "tightens before the beat-up"),
                      operation<&Tension::relax>("relax", "lets go", any_thread),
                      bag("deeds", "what it does", operation<&Tension::relax>("stop", "lets go")));
    }
};
constexpr auto table = loom(components(component<Encoder>("encoder", device("main_encoder")),
                                       component<Shaft>("shaft"), component<Named>("tension"),
                                       component<Weft>("weft"), component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel"))),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

// A property has a dot in its name but no bag.
// refused: loom: component "tension": its property "wanted.n" has a dot in its name; put it into a bag(...) in Named
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Named : Tension {
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      output<&Tension::torque>("torque", "N m", "of the let-off"),
                      operation<&Tension::pre_tension>("pre_tension", "tightens before the beat-up"),
                      operation<&Tension::relax>("relax", "lets go", any_thread),
                      property<&Tension::wanted_n>("wanted.n", "N", "of the warp"));
    }
};
constexpr auto table = loom(components(component<Encoder>("encoder", device("main_encoder")),
                                       component<Shaft>("shaft"), component<Named>("tension"),
                                       component<Weft>("weft"), component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel"))),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

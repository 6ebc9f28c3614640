// The properties of one component do not fit a transaction.
// refused: loom: component "tension" has 1 properties of 2064 bytes, but a transaction holds 64 of 2048; divide the component
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Named : Tension {
    Property<Sequence<double, 256>> notes;
    static constexpr auto interface() {
        return facets(input<&Tension::speed>("speed", "rpm", "of the shaft"),
                      output<&Tension::torque>("torque", "N m", "of the let-off"),
                      operation<&Tension::pre_tension>("pre_tension", "tightens before the beat-up"),
                      operation<&Tension::relax>("relax", "lets go", any_thread),
                      property<&Named::notes>("notes", "", "of the shift"));
    }
};
constexpr auto table = loom(components(component<Encoder>("encoder", device("main_encoder")),
                                       component<Shaft>("shaft"), component<Named>("tension"),
                                       component<Weft>("weft"), component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel"))),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

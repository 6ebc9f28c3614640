// A component's interface gives one name twice.
// refused: loom: component "twin": its interface names "same" twice; rename one in Twin
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
struct Twin {
    Output<double> one;
    Output<double> other;
    static constexpr auto interface() {
        return facets(output<&Twin::one>("same", "", ""), output<&Twin::other>("same", "", ""));
    }
};

constexpr auto table = loom(components(component<Encoder>("encoder", device("main_encoder")),
                                       component<Shaft>("shaft"), component<Tension>("tension"),
                                       component<Weft>("weft"), component<Climate>("climate", device("hall")),
                                       component<Lamps>("lamps", device("panel")), component<Twin>("twin")),
                            good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

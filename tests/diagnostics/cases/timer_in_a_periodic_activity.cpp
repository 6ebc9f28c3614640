// A component with a timer runs in a periodic activity.
// refused: loom: activity "motion" is periodic but component "horn" has the timer "silence", which runs between periods; run it on_work() with at_most(n, per), so that the analysis counts it
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
struct Horn {
    Timer silence;
    void off(const Cycle&) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(timer<&Horn::silence, &Horn::off>("silence", "switches it off"));
    }
};

constexpr auto table =
    loom(components(component<Encoder>("encoder", device("main_encoder")), component<Shaft>("shaft"),
                    component<Tension>("tension"), component<Weft>("weft"),
                    component<Climate>("climate", device("hall")), component<Lamps>("lamps", device("panel")),
                    component<Horn>("horn")),
         activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                             runs("encoder")),
                    activity("motion", every(1ms), budget(120us), runs("shaft", "tension", "horn")),
                    activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us),
                             runs("weft", "lamps")),
                    activity("hall", every(250ms), not_real_time, runs("climate"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board>;

// A wait that no event ends.
// refused: loom: component "panel": no reaction tells its wait "next_index"; add when("...", tell("panel.next_index"))
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Panel {
    EventHandle indexes;
    EventWait<double> next_index;
    void show(double) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(handle<&Panel::indexes>("indexes", "of the encoder", optional),
                      awaits<&Panel::next_index>("next_index", "of the encoder"),
                      operation<&Panel::show>("show", "the angle", any_thread));
    }
};
constexpr auto table = machine(
    "loom", components(component<Encoder>("encoder", device("main_encoder")), component<Panel>("panel")),
    activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                        runs("encoder")),
               activity("all", every(1ms), budget(1us), runs("panel"))),
    connections(), reactions(when("encoder.index", tell("panel.show"), handled_by("panel.indexes"))),
    behaviours());
template struct tappet::Firmware<table, good_board>;

// The handle of a reaction is misspelt.
// refused: loom: reaction "encoder.index" -> "panel.show": component "panel" has no handle of a reaction "index"; did you mean "indexes"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Panel {
    EventHandle indexes;
    EventWait<double> next_index;
    void show(double) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(handle<&Panel::indexes>("indexes", "of the encoder", optional),
                      awaits<&Panel::next_index>("next_index", "of the encoder", optional),
                      operation<&Panel::show>("show", "the angle", any_thread));
    }
};
constexpr auto table = machine(
    "loom", components(component<Encoder>("encoder", device("main_encoder")), component<Panel>("panel")),
    activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                        runs("encoder")),
               activity("all", every(1ms), budget(1us), runs("panel"))),
    connections(), reactions(when("encoder.index", tell("panel.show"), handled_by("panel.index"))),
    behaviours());
template struct tappet::Firmware<table, good_board>;

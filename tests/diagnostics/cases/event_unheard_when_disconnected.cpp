// An event that must be heard is heard only by a reaction that can be disconnected.
// refused: loom: component "panel": its event "broken" is heard by 0 of at least 1 reactions; add when("panel.broken", ...) to reactions(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Panel {
    EventHandle indexes;
    EventWait<double> next_index;
    Event<double> broken;
    void show(double) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() {
        return facets(event<&Panel::broken>("broken", "must be heard", heard_by(1)),
                      handle<&Panel::indexes>("indexes", "of the encoder", optional),
                      awaits<&Panel::next_index>("next_index", "of the encoder", optional),
                      operation<&Panel::show>("show", "the angle", any_thread));
    }
};
constexpr auto table = machine(
    "loom", components(component<Encoder>("encoder", device("main_encoder")), component<Panel>("panel")),
    activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                        runs("encoder")),
               activity("all", every(1ms), budget(1us), runs("panel"))),
    connections(), reactions(when("panel.broken", tell("panel.show"), handled_by("panel.indexes"))),
    behaviours());
template struct tappet::Firmware<table, good_board>;

// A wait for other arguments than the event has.
// refused: loom: reaction "encoder.index" -> "panel.next_index": the event carries (double) but the wait takes (int); give both the same arguments
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Panel {
    EventHandle indexes;
    EventWait<int> next_index;
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
    connections(), reactions(when("encoder.index", tell("panel.next_index"))), behaviours());
template struct tappet::Firmware<table, good_board>;

// A synchronous call inside one activity, of an event that another activity emits too.
// refused: loom: reaction "relay.passed" -> "panel.note": activity "field" runs functions of "relay" too, and would call "panel.note" of activity "all"; use tell(...), or declare it any_thread if it is safe there
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Relay {
    Event<double> passed;
    void pass(double angle) noexcept TAPPET_REALTIME { passed(angle); }
    static constexpr auto interface() {
        return facets(event<&Relay::passed>("passed", "on"),
                      operation<&Relay::pass>("pass", "it on", any_thread));
    }
};
struct Panel {
    void note(double) noexcept TAPPET_REALTIME {}
    static constexpr auto interface() { return facets(operation<&Panel::note>("note", "the angle")); }
};
constexpr auto table =
    machine("loom",
            components(component<Encoder>("encoder", device("main_encoder")), component<Relay>("relay"),
                       component<Panel>("panel")),
            activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                                runs("encoder")),
                       activity("all", every(1ms), budget(1us), runs("relay", "panel"))),
            connections(),
            reactions(when("encoder.index", call("relay.pass")), when("relay.passed", call("panel.note"))),
            behaviours());
template struct tappet::Firmware<table, good_board>;

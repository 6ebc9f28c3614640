// A method of another activity that is not any_thread.
// refused: mill: use "desk.strokes" -> "press.strokes": the call would run "press.strokes" of activity "motion" in activity "desk"; declare the method any_thread if it is safe there, or make it a command
#include "tests/diagnostics/peers.hpp"

using namespace small;

struct StrokeDial {
    MethodCall<int(int)> strokes;
    static constexpr auto interface() {
        return facets(calls<&StrokeDial::strokes>("strokes", "of the press"));
    }
};

constexpr auto table = machine("mill", components(component<Press>("press"), component<StrokeDial>("desk")),
                               activities(activity("motion", every(1ms), budget(100us), runs("press")),
                                          activity("desk", every(10ms), budget(100us), runs("desk"))),
                               connections(), reactions(uses("desk.strokes", "press.strokes")), behaviours());
template struct tappet::Firmware<table, mill_board>;

// An event that must be heard is heard by nobody.
// refused: loom: component "watch": its event "broken" is heard by 0 of at least 1 reactions; add when("watch.broken", ...) to reactions(...)
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Watch {
    Event<> broken;
    static constexpr auto interface() {
        return facets(event<&Watch::broken>("broken", "must be heard", heard_by(1)));
    }
};
constexpr auto table = machine("loom", components(component<Watch>("watch")),
                               activities(activity("all", every(1ms), budget(1us), runs("watch"))),
                               connections(), reactions(), behaviours());
template struct tappet::Firmware<table, good_board>;

// A call that is to reach two methods.
// refused: mill: use "desk.force" -> "right.force": row 1 gives "desk.force" another goal already, "left.force"; a call has one: remove a row, or give "desk" a second call
#include "tests/diagnostics/peers.hpp"

using namespace small;

struct Gauge {
    MethodCall<double(int)> force;
    static constexpr auto interface() { return facets(calls<&Gauge::force>("force", "of a press")); }
};

constexpr auto table = machine(
    "mill", components(component<Press>("left"), component<Press>("right"), component<Gauge>("desk")),
    activities(activity("motion", every(1ms), budget(100us), runs("left", "right", "desk"))), connections(),
    reactions(uses("desk.force", "left.force"), uses("desk.force", "right.force")), behaviours());
template struct tappet::Firmware<table, mill_board>;

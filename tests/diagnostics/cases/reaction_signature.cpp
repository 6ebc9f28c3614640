// The event's arguments are not the operation's.
// refused: loom: reaction "encoder.index" -> "shaft.clear": the event carries (double) but the operation takes (); give both the same arguments
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = [] {
    auto m = good_loom;
    m.reactions[1] = when("encoder.index", tell("shaft.clear"));
    return m;
}();
template struct tappet::Firmware<table, good_board, good_binding>;

// The activities of a processor take more than all of its time.
// refused: loom: activity "motion" is not schedulable on processor 1 of board "bench": the activities there need more than all of its time; lower budgets, lengthen periods, or place it elsewhere
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = [] {
    auto m = good_loom;
    m.activities[1] = activity("motion", every(1ms), deadline(5ms), budget(990us), runs("shaft", "tension"));
    return m;
}();
template struct tappet::Firmware<table, good_board, good_binding>;

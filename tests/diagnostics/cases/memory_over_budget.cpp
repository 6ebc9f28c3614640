// The machine takes more static memory than the board allows.
// refused: loom: board "bench": the machine takes # bytes of static memory (# of them stacks, 100000 the heap) but the board's budget is 1000000; shorten stacks, buffers or slots, or raise memory_budget_bytes
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table = [] {
    auto m = good_loom;
    m.activities[1] =
        activity("motion", every(1ms), budget(120us), stack(2'000'000), runs("shaft", "tension"));
    return m;
}();
template struct tappet::Firmware<table, good_board, good_binding>;

// The machine takes more static memory than the board allows.
// refused: loom: board "bench": the machine takes # bytes of static memory (# of them stacks, 100000 the heap) but the board's budget is 1000000; shorten stacks, buffers or slots, or raise memory_budget_bytes
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

constexpr auto table =
    loom(good_components,
         activities(activity("field", on_device("encoder"), at_most(1, 1ms), deadline(300us), budget(30us),
                             runs("encoder")),
                    activity("motion", every(1ms), budget(120us), stack(2'000'000), runs("shaft", "tension")),
                    activity("logic", on_work(), at_most(4, 10ms), deadline(2ms), budget(80us),
                             runs("weft", "lamps")),
                    activity("hall", every(250ms), not_real_time, runs("climate"))),
         good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, good_board, good_binding>;

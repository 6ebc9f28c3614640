// The board places an activity on a processor it has not.
// refused: loom: activity "motion": board "old box" places it on processor 2 but has processors 0 to 1; correct its placement
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr Board other_board{.name = "old box",
                            .memory_budget_bytes = 1'000'000,
                            .processors = 2,
                            .placement = {{{{"motion", 2}}}, 1},
                            .devices = good_board.devices};

constexpr auto table =
    loom(good_components, good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, other_board>;

// The board places an activity that the table has not.
// refused: loom: board "old box" places activity "motoin", which the table has not; did you mean "motion"?
#include "tests/diagnostics/small_machine.hpp"

using namespace small;
constexpr Board other_board{.name = "old box",
                            .memory_budget_bytes = 1'000'000,
                            .placement = {{{{"motoin", 0}}}, 1},
                            .devices = good_board.devices};

constexpr auto table =
    loom(good_components, good_activities, good_connections, good_reactions, good_behaviours);
template struct tappet::Firmware<table, other_board>;

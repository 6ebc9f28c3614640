// What is called, told, sent and stepped is measured beside its floor, and each goal is judged.
#include "tests/figures/soundness/smoke.hpp"

#include <algorithm>

namespace tappet::figures {
namespace {

TEST(DispatchFigures, stand_beside_their_floors_and_judge_each_goal) {
    const Result result = run_smoke(TAPPET_PROGRAM);
    expect_sound(result);
    for (const char* id : {"dispatch.method",         "dispatch.properties",   "dispatch.cam.row",
                           "dispatch.cam.fire",       "dispatch.command.send", "dispatch.command.execute",
                           "dispatch.command.whole",  "dispatch.emit.none",    "dispatch.emit.call.1",
                           "dispatch.emit.call.2",    "dispatch.emit.call.8",  "dispatch.emit.call.64",
                           "dispatch.emit.tell.1",    "dispatch.emit.tell.2",  "dispatch.emit.tell.8",
                           "dispatch.emit.tell.64",   "dispatch.connect",      "dispatch.step.empty",
                           "dispatch.step.10",        "dispatch.step.100",     "dispatch.step.1000",
                           "dispatch.cycle.stamp",    "dispatch.cycle.idle",   "dispatch.cycle.event",
                           "dispatch.command.for_one"}) {
        const auto found = std::ranges::find(result.figures, id, &Figure::id);
        ASSERT_NE(found, result.figures.end()) << id;
        EXPECT_GT(std::ranges::count(found->rows, Standing::floor, &Row::role), 0) << id;
    }
    EXPECT_EQ(result.goals.size(), 12u);
}

} // namespace
} // namespace tappet::figures

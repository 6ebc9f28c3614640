// Thesis 5.1.4, 5.4: both forms of the tracker's script are the same machine: native code made by the C++
// compiler, and tables walked in memory, as for a loaded script.
#include "apps/car_tracking/machine.hpp"
#include "board/host/board.hpp"
#include "kernel/machine/accept.hpp"
#include "tests/apps/car_tracking/car_run.hpp"

#include <gtest/gtest.h>

namespace tappet::car_tracking {
namespace {

constexpr auto with_tables_walked = [] {
    auto machine = table;
    machine.behaviours[0] = behaviour("tracking", tracking_script, {});
    return machine;
}();

std::uint64_t digest_of(CarRun& run) {
    EXPECT_TRUE(run.start());
    EXPECT_TRUE(run.run_for(30s));
    run.stop();
    EXPECT_GT(run.looks().size(), 30u);
    return run.digest();
}

TEST(CarTrackingForms, native_and_walked_tables_run_identically) {
    for (const std::uint64_t seed : {1u, 8u}) {
        CarRun native{seed};
        CarRun walked{seed, AtRunTime<with_tables_walked, board::host>::machine()};
        EXPECT_EQ(digest_of(native), digest_of(walked)) << "seed " << seed;
    }
}

TEST(CarTrackingForms, the_machine_has_native_code_for_each_type_of_its_script) {
    ASSERT_NE(table.behaviours[0].script, nullptr);
    EXPECT_EQ(table.behaviours[0].code.size(), table.behaviours[0].script->types.size());
}

} // namespace
} // namespace tappet::car_tracking

// Which machines there are.
#include "toolchain/tools/chart/machines.hpp"

#include "apps/car_tracking/behaviour.hpp"
#include "apps/carpet_loom/loom_model.hpp"

#include <array>

namespace tappet::chart {

std::span<const KnownMachine> known_machines() {
    static const auto all = [] {
        std::array<KnownMachine, 2> rows;
        rows[0].machine = carpet::table.view();
        rows[0].model = carpet::loom_model;
        rows[1].machine.name = "car-tracking";
        rows[1].script = &car_tracking::tracking_script;
        rows[1].component = "tracking";
        return rows;
    }();
    return all;
}

} // namespace tappet::chart

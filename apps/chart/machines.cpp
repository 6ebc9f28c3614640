// Which machines there are.
#include "apps/chart/machines.hpp"

#include "apps/carpet_loom/loom_model.hpp"

namespace tappet::chart {

std::span<const KnownMachine> known_machines() {
    static constexpr KnownMachine all[] = {{carpet::carpet_loom.view(), carpet::loom_model}};
    return all;
}

} // namespace tappet::chart

// Reads the lane's plan.
#include "tests/bench/lane/facts.hpp"

#include "apps/woodworking_lane/lane.hpp"

namespace tappet::bench {

std::uint32_t beat_of(std::size_t node) {
    for (const WireFrame& frame : systems::plan_of<woodworking::lane>.frames)
        if (frame.kind == WireFrameKind::beat && frame.node == node) return frame.id;
    return 0;
}
std::chrono::nanoseconds proven_stop_time() {
    Duration longest{};
    for (std::size_t p = 0; p < woodworking::lane.promises.size(); ++p)
        if (woodworking::lane.promises[p].stops)
            longest = std::max(longest, systems::promises_of<woodworking::lane>.proven[p]);
    return longest;
}

} // namespace tappet::bench

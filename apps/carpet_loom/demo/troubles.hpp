// What goes wrong in the demo: some of it by chance, and one of each kind for sure, so that a viewer sees
// them all whatever the chance brings.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace tappet::demo {

/// Words of the plant's command line.
inline std::vector<std::string> troubles(std::int64_t picks) {
    const auto at = [picks](std::int64_t quarter) {
        return std::to_string(std::max<std::int64_t>(picks * quarter / 4, 1));
    };
    return {"--weft-break-one-in", "40",   "--warp-break-one-in", "150", "--weft-break-at",     at(1),
            "--emergency-stop-at", at(2),  "--warp-break-at",     at(3), "--operator-reaction", "500ms",
            "--stop-servers-at",   "3s/2s"};
}

} // namespace tappet::demo

// The summary of a run on the bench: the firmware's and the plant's JSON as one object.
#pragma once

#include <expected>
#include <string>
#include <string_view>

namespace tappet::demo {

/// All keys of the machine stay where they are; of the plant those that judge the machine (stops, cam errors,
/// picks, injected breaks, damage) stand beside them, and the rest of its bookkeeping lies under "plant".
/// Nothing is invented: the error names the key that is missing, of another type, twice there, or in both.
[[nodiscard]] std::expected<std::string, std::string> merge(std::string_view machine, std::string_view plant);

} // namespace tappet::demo

// The bench's camera is Linux's vivid.
#pragma once

#include "kernel/machine/table/binding.hpp"

namespace tappet::camera_bench::bindings {

inline constexpr Binding bench = binding(wired("eye", "camera0"));

} // namespace tappet::camera_bench::bindings

// SPDX-License-Identifier: Apache-2.0
// Stores black boxes as files: keeps a few and replaces the oldest.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/map/black_box.hpp"

#include <cstddef>
#include <span>
#include <string_view>

namespace tappet {

inline constexpr int black_boxes_kept = 8; ///< of one machine

/// Writes and numbers `<directory>/<machine>-N.blackbox`, N from 0, in place of a missing, a damaged or the
/// oldest file, atomically and durably. Returns the path; empty: nothing could be written. Not real-time.
[[nodiscard]] Sentence keep_black_box(std::string_view directory, map::black_box::Record record,
                                      std::span<const std::byte> memory);
/// Appends the machine's answers to browsers; nothing of the machine may run any more. Damaged data may end
/// the calling process: the file is complete without the answers. Not real-time.
void add_answers(const Sentence& file, MachineInstance& instance);

} // namespace tappet

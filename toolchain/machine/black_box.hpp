// SPDX-License-Identifier: Apache-2.0
// Black boxes as files: a few are kept, the oldest goes.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/map/black_box.hpp"

#include <cstddef>
#include <span>
#include <string_view>

namespace tappet {

inline constexpr int black_boxes_kept = 8; ///< of one machine

/// Writes `<directory>/<machine>-N.blackbox`, N from 0, in the place of none, of a damaged one or of the
/// oldest, and numbers it; whole or not at all, and for good. Empty: nothing could be written. Not real-time.
[[nodiscard]] Sentence keep_black_box(std::string_view directory, map::black_box::Record record,
                                      std::span<const std::byte> memory);
/// Adds what the machine, of which nothing runs any more, answers to browsers. What is damaged in it may end
/// the calling process: the file is whole without. Not real-time.
void add_answers(const Sentence& file, MachineInstance& instance);

} // namespace tappet

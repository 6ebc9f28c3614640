// SPDX-License-Identifier: Apache-2.0
// Makes a unified kernel image loadable on a box with little memory.
#pragma once

#include <string>

namespace tappet::image {

/// Places kernel and root directly behind the stub, before the image is signed. The tool that makes unified
/// kernels places them far behind it, so that the loader would request 100 MB in one piece. Throws a fault
/// when the input is no unified kernel.
void draw_together(std::string& unified);

} // namespace tappet::image

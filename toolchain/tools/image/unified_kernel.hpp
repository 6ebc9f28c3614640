// SPDX-License-Identifier: Apache-2.0
// A unified kernel image that a box with little memory can load.
#pragma once

#include <string>

namespace tappet::image {

/// The maker of unified kernels places kernel and root far behind its stub, so that the loader asks for 100
/// MB in one piece. They are placed one behind the other instead, before the image is signed. A fault: it is
/// none.
void draw_together(std::string& unified);

} // namespace tappet::image

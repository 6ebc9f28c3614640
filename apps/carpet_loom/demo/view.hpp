// How the run looks in a terminal: one screen that is drawn again and again, or one plain line now and then.
#pragma once

#include "apps/carpet_loom/demo/story.hpp"

#include <string>
#include <vector>

namespace tappet::demo {

/// What the loom's lines do not say.
struct Frame {
    std::int64_t picks_wanted = 0;
    double wall_s = 0.0;
};

/// The screen's lines with colours, none wider than 100 characters.
[[nodiscard]] std::vector<std::string> screen(const Story& story, const Frame& frame);

/// One line without colours or characters beyond ASCII.
[[nodiscard]] std::string plain_line(const Story& story, const Frame& frame);
[[nodiscard]] std::string plain_stop(const SeenStop& stop);

/// ANSI colours, for those who print words of their own beside the screen.
[[nodiscard]] std::string red(const std::string& text);
[[nodiscard]] std::string green(const std::string& text);

} // namespace tappet::demo

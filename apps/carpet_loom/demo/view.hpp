// How the run looks: the browser's watch picture where there is a terminal, the box's own lines elsewhere.
#pragma once

#include "apps/carpet_loom/demo/story.hpp"
#include "toolchain/tools/browser/screen.hpp"

#include <chrono>
#include <optional>

namespace tappet::demo {

[[nodiscard]] browser::WatchPicture picture_of(const Story& story, std::int64_t picks_wanted, double wall_s);

class View {
public:
    /// `plain`: lines also on a terminal.
    View(bool plain, std::int64_t picks_wanted);

    /// After each line of the box.
    void show(const Story& story, Story::Kind news);
    /// Between them: the clock goes on. Draws at most ten times a second.
    void tick(const Story& story);
    /// The terminal is as it was.
    void finish() { screen_.reset(); }
    [[nodiscard]] bool draws() const { return screen_.has_value(); }

private:
    using Steady = std::chrono::steady_clock;

    std::optional<browser::Screen> screen_;
    std::int64_t picks_wanted_;
    Steady::time_point begun_ = Steady::now(), drawn_at_{};
    std::size_t stops_told_ = 0;
    std::int64_t next_plain_ms_ = 0;
};

} // namespace tappet::demo

// Shows the run: as the browser's watch picture on a terminal, as the box's own lines elsewhere.
#pragma once

#include "apps/carpet_loom/demo/story.hpp"
#include "toolchain/tools/browser/screen.hpp"

#include <chrono>
#include <memory>

namespace tappet::demo {

[[nodiscard]] browser::WatchPicture picture_of(const Story& story, std::int64_t picks_wanted, double wall_s);

class View {
public:
    /// `plain`: prints lines even on a terminal.
    View(bool plain, std::int64_t picks_wanted);

    /// Call after each line of the box.
    void show(const Story& story, Story::Kind news);
    /// Call between lines to advance the clock. Draws at most ten times a second.
    void tick(const Story& story);
    /// Restores the terminal.
    void finish() { screen_.reset(); }
    [[nodiscard]] bool draws() const { return screen_ != nullptr; }

private:
    using Steady = std::chrono::steady_clock;

    std::unique_ptr<const browser::Screen> screen_;
    std::int64_t picks_wanted_;
    Steady::time_point begun_ = Steady::now(), drawn_at_{};
    std::size_t stops_told_ = 0;
    std::int64_t next_plain_ms_ = 0;
};

} // namespace tappet::demo

// The terminal: a screen that is drawn over itself where there is one, plain lines elsewhere.
#pragma once

#include "apps/carpet_loom/demo/view.hpp"

#include <chrono>
#include <cstddef>

namespace tappet::demo {

class Terminal {
public:
    /// `plain`: also on a terminal. A screen needs one that is high enough.
    explicit Terminal(bool plain);
    /// Gives the terminal back as it was.
    ~Terminal();
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    /// After each line of the guest.
    void show(const Story& story, const Frame& frame, Story::Kind news);
    /// Between them: the clock goes on. Draws at most ten times a second.
    void tick(const Story& story, const Frame& frame);
    /// The last picture stays; what is printed afterwards stands below it.
    void finish();

    [[nodiscard]] bool draws() const { return draws_; }

private:
    void draw(const Story& story, const Frame& frame);
    void print_news(const Story& story, const Frame& frame, Story::Kind news);

    bool draws_ = false;
    std::size_t drawn_lines_ = 0;
    std::chrono::steady_clock::time_point drawn_at_{};
    std::size_t stops_told_ = 0;
    std::int64_t next_plain_ms_ = 0;
};

} // namespace tappet::demo

// What a viewer wants to know of the run so far, gathered from what the guest prints.
#pragma once

#include "apps/carpet_loom/demo/status.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tappet::demo {

/// A stop as the machine itself sees it; the plant's own measurement is in the summary.
struct SeenStop {
    std::int64_t after_pick = 0;
    std::string cause;
    double angle_deg = 0.0;
    bool at_stop_angle = false; // braked to it; otherwise it stood still wherever it was, and has no error
    double error_deg = 0.0;
    bool operator==(const SeenStop&) const = default;
};

class Story {
public:
    /// What a line was: a viewer is told of some.
    enum class Kind { status, timing, message };
    Kind take(std::string_view line);

    [[nodiscard]] bool begun() const { return begun_; }
    [[nodiscard]] const Status& status() const { return status_; }
    [[nodiscard]] const Timing& timing() const { return timing_; }
    [[nodiscard]] const std::vector<SeenStop>& stops() const { return stops_; }
    /// Lines that are none of ours, as they came: warnings, refusals with their cures, words of the plant.
    /// The last ones.
    [[nodiscard]] const std::vector<std::string>& messages() const { return messages_; }
    /// The loom's own time since the last pick or the beginning.
    [[nodiscard]] std::int64_t idle_ms() const { return status_.time_ms - last_pick_ms_; }

private:
    void note_stop(const Status& now);

    static constexpr std::size_t most_messages = 200;

    Status status_;
    Timing timing_;
    std::vector<SeenStop> stops_;
    std::vector<std::string> messages_;
    std::int64_t last_pick_ms_ = 0;
    bool begun_ = false;
};

} // namespace tappet::demo

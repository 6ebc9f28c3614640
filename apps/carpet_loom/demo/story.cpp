// Gathering: what the difference between two lines of status means.
#include "apps/carpet_loom/demo/story.hpp"

#include "apps/carpet_loom/wires.hpp"

#include <utility>

namespace tappet::demo {

Story::Kind Story::take(std::string_view line) {
    if (auto timing = parse_timing(line)) {
        timing_ = *std::move(timing);
        return Kind::timing;
    }
    auto now = parse_status(line);
    if (!now) {
        if (!line.empty()) messages_.emplace_back(line);
        if (messages_.size() > most_messages) messages_.erase(messages_.begin());
        return Kind::message;
    }
    if (begun_) note_stop(*now);
    if (!begun_ || now->picks != status_.picks) last_pick_ms_ = now->time_ms;
    begun_ = true;
    status_ = *std::move(now);
    return Kind::status;
}

void Story::note_stop(const Status& now) {
    const bool at_stop_angle = now.stops > status_.stops;
    // Everything else the machine counts once the shaft stands at the stop angle.
    const bool wherever = now.cause == "emergency" || now.cause == "fault";
    const bool came_to_stand = wherever && status_.speed_rpm != 0 && now.speed_rpm == 0;
    if (!at_stop_angle && !came_to_stand) return;
    SeenStop stop{.after_pick = now.picks, .cause = now.cause, .at_stop_angle = at_stop_angle};
    stop.error_deg = at_stop_angle ? now.stop_error_deg : 0.0;
    stop.angle_deg = at_stop_angle ? loom::wires::nominal::stop_deg + now.stop_error_deg
                                   : static_cast<double>(now.angle_deg);
    stops_.push_back(std::move(stop));
}

} // namespace tappet::demo

// What the firmware prints while it runs, read back: the console's line of status and the line of worst
// responses.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::demo {

/// One line of apps/carpet_loom/console.hpp.
struct Status {
    std::int64_t time_ms = 0; // the loom's own time
    std::string state;
    std::int64_t speed_rpm = 0;
    std::int64_t angle_deg = 0;
    std::int64_t picks = 0;
    std::int64_t tension_n = 0;
    double oil_bar = 0.0;
    std::int64_t stops = 0; // at the stop angle
    std::string cause;
    double stop_error_deg = 0.0; // of the last of them
    std::int64_t bus_state = 0;
    std::int64_t frames_lost = 0;
    std::int64_t edges_lost = 0;
    std::int64_t outages = 0;
    bool operator==(const Status&) const = default;
};

struct Response {
    std::string activity;
    std::int64_t worst_us = 0;
    std::int64_t deadline_us = 0;
    bool operator==(const Response&) const = default;
};

struct Timing {
    std::vector<Response> responses;
    std::int64_t misses = 0;
    bool operator==(const Timing&) const = default;
};

/// Nothing when the line is another one, is cut, or holds what is no number; words that are not known are
/// skipped.
[[nodiscard]] std::optional<Status> parse_status(std::string_view line);
[[nodiscard]] std::optional<Timing> parse_timing(std::string_view line);

/// Cuts a stream of bytes into lines, however it comes in pieces.
class Lines {
public:
    /// Calls take(line) for each line that is complete now; carriage returns are dropped.
    template <class Take> void add(std::string_view bytes, Take&& take) {
        for (const char character : bytes) {
            if (character == '\n') {
                take(std::string_view{rest_});
                rest_.clear();
            } else if (character != '\r' && rest_.size() < longest) {
                rest_ += character;
            }
        }
    }
    /// What came after the last line's end.
    [[nodiscard]] const std::string& rest() const { return rest_; }

private:
    static constexpr std::size_t longest = 4096;
    std::string rest_;
};

} // namespace tappet::demo

// The rules of sending, the same for the real controller and its twin: few frames in flight, none of them
// stale.
#pragma once

#include "drivers/can/frame_time.hpp"
#include "drivers/can/transmit_queue.hpp"
#include "kernel/base/bounded.hpp"

#include <algorithm>

namespace tappet::can {

inline constexpr std::uint32_t most_in_flight = 8; // the kernel's own queue refuses the eleventh

/// Returns the fewest frames that keep the bus busy until the next is handed over, which takes `hand_over`;
/// more would only delay urgent ones. `shortest`: the machine's shortest frame on the wire, with full bit
/// stuffing.
constexpr std::uint32_t frames_in_flight(Duration hand_over, Duration shortest) noexcept {
    const Duration least{least_time_ns(shortest.count())};
    std::uint32_t fewest = 2;
    while (fewest < most_in_flight && hand_over > (fewest - 1) * least) ++fewest;
    return fewest;
}

/// Frames are queued here, not in the kernel, because a frame in the kernel or the controller cannot be
/// withdrawn. So at most `in_flight` frames are handed over before one is confirmed (sent and acknowledged on
/// the wire).
class Transmitter {
public:
    constexpr void configure(const Settings& settings) noexcept {
        in_flight_limit_ = std::clamp(settings.in_flight, 1u, most_in_flight);
        max_age_ = settings.max_age;
        confirm_within_ = settings.confirm_within;
    }
    /// Queues a frame whose contents were made at frame.stamp; refuses contents made before the last restart.
    constexpr Send push(const Frame& frame, Keep keep, Counters& count) noexcept TAPPET_REALTIME {
        Send answer = Send::refused_invalid;
        if (valid(frame)) {
            // A final frame counts as fresh, even if a restart was taken up at the same moment.
            const bool fresh =
                keep == Keep::last || (frame.stamp > restarted_at_ && frame.stamp >= now_ - max_age_);
            answer = fresh ? queue_.push(frame, keep) : Send::refused_stale;
        }
        if (answer == Send::replaced) ++count.replaced;
        if (answer != Send::queued && answer != Send::replaced) ++count.refused;
        return answer;
    }
    /// Returns the frame to hand over now, or null.
    constexpr const Frame* next(Time now, Counters& count) noexcept TAPPET_REALTIME {
        now_ = now;
        count.dropped_stale += queue_.drop_older(now - max_age_);
        return in_flight_.size() < in_flight_limit_ ? queue_.front() : nullptr;
    }
    constexpr void handed_over(Time now) noexcept TAPPET_REALTIME {
        const Frame* frame = queue_.front();
        if (frame == nullptr) return;
        if (in_flight_.push({frame->stamp, now, {frame->id, frame->extended}})) queue_.pop();
    }
    /// See Controller::take_waiting().
    constexpr bool take_waiting(Frame& frame) noexcept TAPPET_REALTIME {
        if (queue_.front() == nullptr) return false;
        frame = *queue_.front();
        queue_.pop();
        return true;
    }
    /// A frame that was handed over.
    struct Flight {
        Time made{};
        Time handed_over{};
        Identifier identifier{};
        bool operator==(const Flight&) const = default;
    };
    /// Returns the oldest frame in flight, which the controller confirmed at `now`; made at Time{}: none.
    constexpr Flight confirmed(Time now, Counters& count) noexcept TAPPET_REALTIME {
        if (in_flight_.empty() || now <= restarted_at_) return {}; // confirms a frame sent before the restart
        const Flight sent = in_flight_[0];
        ++count.sent;
        if (now - sent.made > max_age_) ++count.sent_late;
        for (std::size_t i = 1; i < in_flight_.size(); ++i) in_flight_[i - 1] = in_flight_[i];
        --in_flight_.used;
        return sent;
    }
    [[nodiscard]] constexpr bool unacknowledged(Time now, int times = 1) const noexcept TAPPET_REALTIME {
        return !in_flight_.empty() && now - in_flight_[0].handed_over > times * confirm_within_;
    }
    [[nodiscard]] constexpr Time next_timeout() const noexcept TAPPET_REALTIME {
        return in_flight_.empty() ? never : in_flight_[0].handed_over + confirm_within_ + 1ns;
    }
    constexpr void purge(Counters& count) noexcept TAPPET_REALTIME { count.dropped_stale += queue_.purge(); }
    /// Forgets the frames in flight, as the controller did. Contents made up to now are never sent.
    constexpr void restarted(Time now, Counters& count) noexcept TAPPET_REALTIME {
        purge(count);
        count.dropped_stale += in_flight_.size();
        in_flight_.clear();
        restarted_at_ = now_ = now;
    }
    [[nodiscard]] constexpr std::size_t waiting() const noexcept TAPPET_REALTIME { return queue_.size(); }
    [[nodiscard]] constexpr bool is_filled(std::size_t parts) const noexcept TAPPET_REALTIME {
        return parts * in_flight_.size() >= in_flight_limit_;
    }
    [[nodiscard]] constexpr Duration confirm_within() const noexcept TAPPET_REALTIME {
        return confirm_within_;
    }
    [[nodiscard]] constexpr std::size_t in_flight() const noexcept TAPPET_REALTIME {
        return in_flight_.size();
    }

private:
    TransmitQueue queue_{};
    Bounded<Flight, most_in_flight> in_flight_{};
    std::uint32_t in_flight_limit_ = Settings{}.in_flight;
    Duration max_age_ = 20ms;
    Duration confirm_within_ = 50ms;
    Time restarted_at_ = Time::min();
    Time now_{};
};

} // namespace tappet::can

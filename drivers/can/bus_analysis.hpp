// Response-time analysis of the frames on one bus, in whole nanoseconds at compile time: Davis, Burns, Bril
// and Lukkien 2007, with errors, and with the real send queue for this machine's frames.
#pragma once

#include "drivers/can/frame_time.hpp"
#include "kernel/base/response.hpp"
#include "kernel/component/device_traffic.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

namespace tappet::can {

/// Timing of all frames with one identifier.
struct FrameTiming {
    std::int64_t wire_ns = 0;     ///< longest time on the wire
    std::int64_t period_ns = 0;   ///< least time between two frames
    std::int64_t jitter_ns = 0;   ///< longest time from its release to its node's queue
    std::int64_t deadline_ns = 0; ///< from its release
    bool own = false;             ///< it is sent by this machine's queue
    bool on_grid = false;         ///< all such frames are released at multiples of their periods
};

/// The bus, and how this machine sends: from a queue ordered by identifier. The controller holds `in_flight`
/// of the frames, in the order of their hand-over, and does not return them.
struct BusTiming {
    std::int64_t bit_ns = 0;
    std::int64_t in_flight = 1;
    std::int64_t hand_over_ns = 0; ///< from the end of a frame until the next one is handed over
    std::int64_t errors = 0;       ///< at the worst moment, this many errors at once ..
    std::int64_t errors_every_ns = analysis_max_ns; ///< .. and one more after each such time
};

/// The parts of a worst case.
enum class Part : std::uint8_t { jitter, own_time, blocking, in_flight, handing_over, others, errors };

struct FrameResponse {
    Response response{};
    Part largest = Part::own_time;
    std::size_t of = 0; ///< the frame that causes it, for the parts `others` and `blocking`
    std::int64_t largest_ns = 0;
};

/// Analysis of one bus. Frames are in the order of arbitration: by identifier, a base frame before an
/// extended one with the same first 11 bits.
///
/// A frame of another node is delayed by one frame of lower priority that has just started, and by all of
/// higher priority; its node is assumed to send the most urgent of its own first. A frame of this machine
/// also waits for up to `in_flight` less urgent ones that the controller already holds. While these wait for
/// arbitration, every frame of other nodes passes that is more urgent than the least urgent of them (after
/// Davis, Kollmann, Pollex and Slomka 2011, on FIFO queues; here only the frames in flight form one). When
/// both frames are on the grid, the less urgent one does not count if it is sent before the other can be
/// released. For all other frames, the wait behind the frames in flight is one more jitter of this frame.
class BusAnalysis {
public:
    /// A bus with more identifiers is not analysed.
    static constexpr std::size_t most_frames = most_traffic_rows;

    constexpr BusAnalysis(std::span<const FrameTiming> by_priority_highest_first,
                          const BusTiming& bus) noexcept
        : frames_{by_priority_highest_first}, bus_{bus} {
        for (std::size_t i = 0; i < std::min(frames_.size(), most_frames); ++i)
            if (frames_[i].own) own_[own_count_++] = last_own_ = i;
        for (const FrameTiming& frame : frames_) {
            sensible_ &= frame.period_ns > 0 && frame.period_ns <= analysis_max_ns && frame.wire_ns > 0 &&
                         frame.wire_ns <= analysis_max_ns && Span{frame.jitter_ns}.exists();
            if (frame.own) shortest_own_ns_ = std::min(shortest_own_ns_, frame.wire_ns);
        }
        for (std::size_t i = 0; i < std::min(frames_.size(), most_frames); ++i) set_late(i, Span{0});
        sensible_ &= frames_.size() <= most_frames && bus_.bit_ns > 0 && bus_.in_flight >= 1 &&
                     Span{bus_.hand_over_ns}.exists() && bus_.errors >= 0 && bus_.errors_every_ns > 0;
        // Starts with only frames on demand in flight, and adds those that are not sent in time, until there
        // are no more: then no frame can be the first late one.
        for (bool again = sensible_; again;) {
            again = false;
            for (std::size_t o = 0; o < own_count_; ++o) set_late(own_[o], behind_those_in_flight(own_[o]));
            for (std::size_t o = 0; o < own_count_; ++o) {
                const std::size_t i = own_[o];
                of_own_[i] = of_own(i);
                const Response& found = of_own_[i].response;
                const std::int64_t worst_ns = found.bounded ? found.worst_ns : analysis_max_ns;
                again |= worst_ns > worst_ns_[i];
                worst_ns_[i] = std::max(worst_ns_[i], worst_ns);
            }
        }
    }

    /// Returns the response of a frame, from its release to its end on the wire.
    [[nodiscard]] constexpr FrameResponse of(std::size_t index) const noexcept {
        if (index >= frames_.size() || !sensible_) return {};
        return frames_[index].own ? of_own_[index] : of_another_node(index);
    }

    /// Returns how much later a frame of this machine may reach the wire, because of less urgent ones in
    /// flight. For other nodes it is one more jitter.
    [[nodiscard]] constexpr std::int64_t late_ns(std::size_t index) const noexcept { return late_ns_[index]; }

private:
    using Span = analysis::Span;

    [[nodiscard]] constexpr std::int64_t longest_below(std::size_t index, bool others_only,
                                                       std::size_t& which) const noexcept {
        std::int64_t longest = 0;
        for (std::size_t k = index + 1; k < frames_.size(); ++k) {
            if (others_only && frames_[k].own) continue;
            if (frames_[k].wire_ns > longest) longest = frames_[k].wire_ns, which = k;
        }
        return longest;
    }
    /// Returns whether a less urgent frame of this machine is sent before the other one can be released.
    [[nodiscard]] constexpr bool is_through_before(std::size_t less_urgent,
                                                   std::size_t index) const noexcept {
        const FrameTiming& first = frames_[less_urgent];
        const FrameTiming& then = frames_[index];
        return first.on_grid && then.on_grid &&
               worst_ns_[less_urgent] <= std::gcd(first.period_ns, then.period_ns);
    }
    /// The most less urgent frames of this machine in flight, and the time of the longest of them together.
    struct InFlight {
        std::int64_t count = 0, ns = 0;
    };
    [[nodiscard]] constexpr InFlight in_flight_below(std::size_t index) const noexcept {
        InFlight found;
        std::int64_t limit = analysis_max_ns; // the last one counted; of equal ones none counts twice
        std::size_t taken = frames_.size();
        while (found.count < bus_.in_flight) {
            std::size_t next = frames_.size();
            for (std::size_t i = own_count_; i > 0 && own_[i - 1] > index; --i) {
                const std::size_t k = own_[i - 1];
                if (is_through_before(k, index)) continue;
                const bool left = frames_[k].wire_ns < limit || (frames_[k].wire_ns == limit && k > taken);
                if (left && (next == frames_.size() || frames_[k].wire_ns >= frames_[next].wire_ns)) next = k;
            }
            if (next == frames_.size()) break;
            limit = frames_[next].wire_ns, taken = next;
            found.ns += limit;
            ++found.count;
        }
        return found;
    }
    /// Returns the time of errors: an error frame and the longest destroyed frame, of `index` or more urgent.
    [[nodiscard]] constexpr Span spoilt(Span window, std::size_t index) const noexcept {
        if (bus_.errors == 0) return Span{0};
        std::int64_t longest = 0;
        for (std::size_t k = 0; k <= index; ++k) longest = std::max(longest, frames_[k].wire_ns);
        const std::int64_t count =
            bus_.errors + std::max<std::int64_t>(0, analysis::arrivals(window, bus_.errors_every_ns) - 1);
        return count * Span{error_frame_bits * bus_.bit_ns + longest};
    }
    constexpr void set_late(std::size_t index, Span late) noexcept {
        late_ns_[index] = late.ns;
        lead_ns_[index] = (Span{frames_[index].jitter_ns} + late + Span{bus_.bit_ns}).ns;
    }
    /// Returns the time of frame k in the window: it wins up to one bit after this frame would start.
    [[nodiscard]] constexpr Span passing(Span window, std::size_t k) const noexcept {
        return analysis::arrivals(window + Span{lead_ns_[k]}, frames_[k].period_ns) *
               Span{frames_[k].wire_ns};
    }
    /// Returns the same for all frames before `end`, of other nodes only or of this machine, too; adds the
    /// number of this machine's to `ours`. Written out, because the compiler spends most of its time here.
    [[nodiscard]] constexpr Span passing_before(std::size_t end, bool others_only, Span window,
                                                std::int64_t& ours) const noexcept {
        if (!window.exists()) return Span{};
        std::int64_t sum = 0;
        const FrameTiming* frame = frames_.data();
        const std::int64_t* lead = lead_ns_.data();
        for (std::size_t k = 0; k < end; ++k, ++frame, ++lead) {
            if (others_only && frame->own) continue;
            const std::int64_t from = window.ns + *lead;
            if (*lead < 0 || from > analysis_max_ns) return Span{};
            const std::int64_t count = (from + frame->period_ns - 1) / frame->period_ns;
            std::int64_t time = 0;
            if (__builtin_mul_overflow(count, frame->wire_ns, &time) || time > analysis_max_ns - sum)
                return Span{};
            sum += time;
            if (frame->own) ours += count;
        }
        return Span{sum};
    }
    /// Returns the time until the less urgent ones in flight are sent: it delays this machine's frames.
    [[nodiscard]] constexpr Span behind_those_in_flight(std::size_t index) const noexcept {
        std::int64_t steps = analysis_max_steps;
        const InFlight before = in_flight_below(index);
        if (before.count == 0) return Span{0};
        std::size_t which = 0;
        const Span first{std::max(longest_below(last_own_, true, which), frames_[index].wire_ns) + before.ns};
        return analysis::fixed_point(first, steps, [&](Span window) {
            std::int64_t ours = 0;
            return first + spoilt(window, last_own_) + passing_before(last_own_, true, window, ours);
        });
    }
    [[nodiscard]] constexpr FrameResponse of_own(std::size_t index) noexcept {
        const FrameTiming& own = frames_[index];
        std::int64_t steps = analysis_max_steps;
        const InFlight before = in_flight_below(index);
        // The previous frame of the same identifier may have delayed those that pass now (push-through).
        std::size_t blocker = index;
        const std::int64_t below = longest_below(last_own_, true, blocker);
        const std::int64_t blocking = std::max(below, own.wire_ns);
        if (below < own.wire_ns) blocker = index;
        // When all frames in flight are sent before more are handed over, a less urgent frame may start in
        // the gap; then as many as may be in flight are handed over together.
        std::size_t unused = 0;
        // With or without stuffing: the bus time that they save is added to that gap.
        const std::int64_t behind = (bus_.in_flight - 1) * shortest_own_ns_;
        const bool may_idle = bus_.hand_over_ns > least_time_ns(behind);
        const std::int64_t gap =
            may_idle
                ? std::max<std::int64_t>(0, bus_.hand_over_ns - behind + longest_below(index, true, unused))
                : 0;
        const auto gaps = [&](std::int64_t ours) {
            return (before.count + ours + bus_.in_flight - 1) / bus_.in_flight * Span{gap};
        };
        FrameResponse found;
        Span less_urgent{0}; // of other nodes, while this machine's in flight wait
        for (std::size_t k = index + 1; before.count > 0 && k < last_own_; ++k)
            if (!frames_[k].own) {
                const Span passed = passing(Span{late_ns_[index]}, k);
                less_urgent = less_urgent + passed;
                consider(found, Part::others, k, passed);
            }
        const Span fixed = Span{blocking} + Span{before.ns} + less_urgent;
        const std::size_t spoils = before.count > 0 ? last_own_ : index; // up to the least urgent one ahead
        std::int64_t ours = 0; // number of more urgent ones in the window
        // The last result is a lower bound, because the wait only grows.
        const Span start{std::max(fixed.ns, wait_ns_[index])};
        const Span wait = analysis::fixed_point(fixed.exists() ? start : fixed, steps, [&](Span window) {
            ours = 0;
            const Span passed = passing_before(index, false, window, ours);
            return fixed + gaps(ours) + spoilt(window + Span{own.wire_ns}, spoils) + passed;
        });
        if (!wait.exists()) return found;
        wait_ns_[index] = wait.ns;
        consider_passing(found, wait, index);
        consider(found, Part::jitter, index, Span{own.jitter_ns});
        consider(found, Part::own_time, index, Span{own.wire_ns});
        consider(found, Part::in_flight, index, Span{before.ns});
        consider(found, Part::handing_over, index, gaps(ours));
        consider(found, blocker == index ? Part::own_time : Part::blocking, blocker, Span{blocking});
        consider(found, Part::errors, index, spoilt(wait + Span{own.wire_ns}, spoils));
        // When it exceeds a period, the previous frame still waits, and there is no bound.
        const std::int64_t worst_ns = own.jitter_ns + wait.ns + own.wire_ns;
        if (worst_ns <= own.period_ns) found.response = {true, worst_ns};
        return found;
    }

    [[nodiscard]] constexpr FrameResponse of_another_node(std::size_t index) const noexcept {
        const FrameTiming& own = frames_[index];
        std::int64_t steps = analysis_max_steps;
        std::size_t blocker = index;
        const Span blocking{longest_below(index, false, blocker)};
        const Span frame{own.wire_ns};
        const Span jitter{own.jitter_ns};
        const auto busy_with = [&](Span window) {
            Span sum = blocking + spoilt(window, index);
            for (std::size_t k = 0; k < index; ++k)
                sum = sum + analysis::arrivals(window + Span{frames_[k].jitter_ns} + Span{late_ns_[k]},
                                               frames_[k].period_ns) *
                                Span{frames_[k].wire_ns};
            return sum + analysis::arrivals(window + jitter, own.period_ns) * frame;
        };
        FrameResponse found;
        const Span busy = analysis::fixed_point(frame, steps, busy_with);
        if (!busy.exists()) return found;
        const std::int64_t frames = analysis::arrivals(busy + jitter, own.period_ns);
        std::int64_t worst_ns = -1;
        Span worst_wait{};
        for (std::int64_t nth = 0; nth < frames; ++nth) {
            const Span before = blocking + nth * frame;
            const Span wait = analysis::fixed_point(before, steps, [&](Span window) {
                std::int64_t ours = 0;
                return before + spoilt(window + frame, index) + passing_before(index, false, window, ours);
            });
            if (!wait.exists()) return found;
            if (const std::int64_t ns = jitter.ns + wait.ns - nth * own.period_ns + frame.ns; ns > worst_ns)
                worst_ns = ns, worst_wait = wait;
        }
        consider_passing(found, worst_wait, index);
        consider(found, Part::jitter, index, jitter);
        consider(found, Part::own_time, index, frame);
        consider(found, Part::blocking, blocker, blocking);
        consider(found, Part::errors, index, spoilt(worst_wait + frame, index));
        found.response = {true, worst_ns};
        return found;
    }

    /// Considers the times that passing_before() has shown to be finite.
    constexpr void consider_passing(FrameResponse& found, Span window, std::size_t end) const noexcept {
        for (std::size_t k = 0; k < end; ++k) {
            const FrameTiming& frame = frames_.data()[k];
            const std::int64_t from = window.ns + lead_ns_.data()[k];
            const std::int64_t time = (from + frame.period_ns - 1) / frame.period_ns * frame.wire_ns;
            if (time > found.largest_ns) found.largest = Part::others, found.of = k, found.largest_ns = time;
        }
    }
    static constexpr void consider(FrameResponse& found, Part part, std::size_t of, Span ns) noexcept {
        if (ns.ns <= found.largest_ns) return;
        found.largest = part, found.of = of, found.largest_ns = ns.ns;
    }

    std::span<const FrameTiming> frames_;
    BusTiming bus_;
    std::array<std::size_t, most_frames> own_{}; // their indices
    std::size_t own_count_ = 0;
    std::size_t last_own_ = 0;
    std::int64_t shortest_own_ns_ = analysis_max_ns;
    std::array<std::int64_t, most_frames> worst_ns_{}; // of this machine's frames, as far as known
    std::array<std::int64_t, most_frames> late_ns_{};  // of this machine's, behind less urgent ones in flight
    std::array<std::int64_t, most_frames>
        lead_ns_{}; // how long before a window's start an arrival still counts
    std::array<std::int64_t, most_frames> wait_ns_{}; // of this machine's, as found so far
    std::array<FrameResponse, most_frames> of_own_{};
    bool sensible_ = true;
};

} // namespace tappet::can

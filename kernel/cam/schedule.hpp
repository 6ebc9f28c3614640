// Executes a cam table: predicts the next firing from the shaft's motion, and fires what is due. On a sample:
// estimator.sample(); schedule.update(estimator, now); arm a one-shot timer at schedule.next_due(). On the
// timer: schedule.advance(now, fire); arm it again.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/cam/angle.hpp"
#include "kernel/cam/estimator.hpp"
#include "kernel/cam/motion.hpp"
#include "kernel/cam/table.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace tappet {

enum class CamKind : std::uint8_t { point, enter, leave };

/// The argument of the caller's `fire`.
struct CamEvent {
    std::size_t row = 0;
    CamKind kind = CamKind::point;
    bool forward = true;
    bool forced = false;    // left without reaching its angle: the shaft stands, is lost or is elsewhere
    ShaftPosition target;   // the crossing: the row's angle in the turn of this firing
    ShaftPosition position; // of the shaft, at the firing
    ShaftPosition effect;   // predicted, at the end of the dead time
    double late_deg = 0.0;  // effect behind target in the direction of turning; negative: ahead of it
};

struct CamProperties {
    /// How far the shaft must turn away before a crossing counts again: more than one step of the encoder.
    Rotation hysteresis = Rotation::degrees(3.0);
    Rotation late_from = Rotation::degrees(1.0);  // counted as late from here on
    Rotation skip_from = Rotation::degrees(90.0); // beyond this it is skipped and counted, not fired
};

struct CamCounters {
    std::uint64_t fired = 0;
    std::uint64_t late = 0;
    std::uint64_t skipped_late = 0;  // beyond skip_from
    std::uint64_t skipped_slow = 0;  // crossed below min_speed, or while stopping
    std::uint64_t skipped_reset = 0; // jumped over when the encoder restarted
    std::uint64_t forced = 0;        // windows left before their angle came
    double latest_deg = 0.0;
    constexpr bool operator==(const CamCounters&) const = default;
};

/// The rows of one table at run time. Each crossing fires exactly once, in the order of the angles. All calls
/// take time bounded by the number of rows; one activity owns it. A window that contains the shaft at the
/// beginning is not entered: only crossings cause events. An entered window is left exactly once: at its
/// angle, or at once when the angle will not come because the shaft stands or the estimate is stale. Nothing
/// else fires on a stale estimate.
template <std::size_t N> class CamSchedule {
public:
    /// Contract: check(table.view()) is empty.
    explicit constexpr CamSchedule(const CamTable<N>& table, const CamProperties& properties = {}) noexcept
        : properties_(properties) {
        for (std::size_t i = 0; i < N; ++i) {
            const CamRow& row = table.rows[i];
            longest_dead_ = std::max({longest_dead_, row.dead_time, row.leave_dead_time});
            if (row.is_window) {
                // Forward, begin enters and end leaves; backward, end enters.
                insert(row, i, End::begin, row.enter, row.dead_time, row.leave_dead_time);
                insert(row, i, End::end, row.leave, row.leave_dead_time, row.dead_time);
            } else {
                insert(row, i, End::point, row.enter, row.dead_time, row.dead_time);
            }
        }
    }

    /// Takes over the shaft's motion and predicts every row again. Fires nothing. Real-time, O(N).
    void update(const ShaftEstimator& estimator, Time now) noexcept TAPPET_REALTIME {
        good_until_ = estimator.valid_until();
        if (now > good_until_) {
            next_due_ = is_any_open() ? now : never;
            return;
        }
        motion_ = estimator.motion().from(now);
        reach_ = motion_.at(good_until_ + longest_dead_).position;
        const ShaftPosition here = motion_.state.position;
        if (!started_ || estimator.epoch() != epoch_) jump_to(here);
        epoch_ = estimator.epoch();
        started_ = true;
        for (std::size_t i = 0; i < used_; ++i) {
            if (estimator.standing()) edges_[i].must_leave = is_open_end(edges_[i]);
            track(edges_[i], here);
            plan(edges_[i]);
        }
        find_next_due();
    }

    /// Returns when to call advance() next: at or before now means at once. `never` when nothing is due while
    /// the present estimate is good and no window is open: the next update decides. Real-time.
    [[nodiscard]] Time next_due() const noexcept TAPPET_REALTIME { return next_due_; }

    /// Calls fire(const CamEvent&) for every event due at `now`. Real-time when `fire` is, O(N).
    template <class Fire> void advance(Time now, Fire&& fire) noexcept TAPPET_REALTIME {
        if (next_due_ > now) return;
        if (now > good_until_) {
            leave_all(fire);
            next_due_ = never;
            return;
        }
        motion_ = motion_.from(now);
        const bool forward = motion_.state.velocity_deg_s >= 0.0;
        std::size_t i = first_due(now, forward);
        for (std::size_t n = 0; n < used_; ++n) {
            if (edges_[i].due <= now) serve(edges_[i], fire);
            i = forward ? (i + 1 == used_ ? 0 : i + 1) : (i == 0 ? used_ - 1 : i - 1);
        }
        find_next_due();
    }

    /// Leaves every open window, for a caller that stops following the shaft. Real-time when `fire` is, O(N).
    template <class Fire> void leave_all(Fire&& fire) noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < used_; ++i)
            if (is_open_end(edges_[i])) leave(edges_[i], fire);
    }

    /// Returns whether a window was entered and not yet left. Real-time.
    [[nodiscard]] bool inside(std::size_t row) const noexcept TAPPET_REALTIME { return inside_[row]; }
    [[nodiscard]] const CamCounters& counters() const noexcept TAPPET_REALTIME { return counters_; }

private:
    enum class End : std::uint8_t { point, begin, end };
    // After a crossing, crossing back counts only once the shaft has turned `hysteresis` away from it.
    enum class Closed : std::uint8_t { none, below, above };

    // One angle of one row. The shaft is between `below` and `below` + one turn; both are at `angle`.
    struct Edge {
        Angle angle;
        std::size_t row = 0;
        End end = End::point;
        Direction direction = Direction::forward;
        double min_speed_deg_s = 0.0;
        Angle begin; // of the row's window
        Rotation width;
        Duration forward_dead = Duration::zero();
        Duration backward_dead = Duration::zero();
        ShaftPosition below{};
        Closed closed = Closed::none;
        ShaftPosition
            furthest{}; // position since the crossing, at most the angle: hysteresis is measured from here
        std::int8_t side = 1; // planned crossing: 1 forward at `below` + one turn, -1 backward at `below`
        bool must_leave = false;
        Time due = never;
    };

    // Sorted by angle; at one angle ends precede begins, so that adjacent windows are never open together.
    constexpr void insert(const CamRow& row, std::size_t index, End end, Rotation angle,
                          Duration forward_dead, Duration backward_dead) noexcept {
        Edge edge;
        edge.angle = angle;
        edge.row = index;
        edge.end = end;
        edge.direction = row.direction;
        edge.min_speed_deg_s = row.min_speed.in_deg_s();
        edge.begin = row.enter;
        edge.width = forward_way(row.enter, row.leave);
        edge.forward_dead = forward_dead;
        edge.backward_dead = backward_dead;
        const auto rank = [](const Edge& e) {
            return (std::uint64_t{e.angle.in_units()} << 1) | (e.end == End::end ? 0u : 1u);
        };
        std::size_t i = used_++;
        for (; i > 0 && rank(edges_[i - 1]) > rank(edge); --i) edges_[i] = edges_[i - 1];
        edges_[i] = edge;
    }

    static constexpr ShaftPosition above(const Edge& e) noexcept TAPPET_REALTIME {
        return e.below + Rotation::turns(1);
    }
    static constexpr CamKind kind(const Edge& e, int side) noexcept TAPPET_REALTIME {
        if (e.end == End::point) return CamKind::point;
        return (e.end == End::begin) == (side > 0) ? CamKind::enter : CamKind::leave;
    }
    static constexpr bool allows(const Edge& e, int side) noexcept TAPPET_REALTIME {
        return e.direction == Direction::both || (e.direction == Direction::forward) == (side > 0);
    }
    static constexpr Duration dead(const Edge& e) noexcept TAPPET_REALTIME {
        return e.side > 0 ? e.forward_dead : e.backward_dead;
    }
    // Returns true for the end edge of an open window: of its two edges, this one performs a forced leave.
    [[nodiscard]] constexpr bool is_open_end(const Edge& e) const noexcept TAPPET_REALTIME {
        return e.end == End::end && inside_[e.row];
    }
    [[nodiscard]] constexpr bool is_any_open() const noexcept TAPPET_REALTIME {
        for (const bool open : inside_)
            if (open) return true;
        return false;
    }
    // The estimate may become stale without a call: with an open window, check again at that time.
    void find_next_due() noexcept TAPPET_REALTIME {
        next_due_ = is_any_open() ? good_until_ + Duration{1} : never;
        for (std::size_t i = 0; i < used_; ++i) next_due_ = std::min(next_due_, edges_[i].due);
    }
    [[nodiscard]] constexpr bool open_ahead(const Edge& e) const noexcept TAPPET_REALTIME {
        return e.closed != (e.side > 0 ? Closed::above : Closed::below);
    }

    // Sets the place of an edge from the shaft's position alone: at the start and after the encoder
    // restarted.
    constexpr void jump_to(ShaftPosition here) noexcept TAPPET_REALTIME {
        for (std::size_t i = 0; i < used_; ++i) {
            Edge& e = edges_[i];
            const ShaftPosition below = here - forward_way(e.angle, here.angle());
            const std::int64_t turns = (below - e.below).in_units() >> 32;
            const int side = turns > 0 ? 1 : -1;
            if (started_ && turns != 0 && kind(e, side) != CamKind::leave && allows(e, side))
                counters_.skipped_reset += static_cast<std::uint64_t>(turns > 0 ? turns : -turns);
            e.below = below;
            // Just past the angle: jitter back over it is no crossing.
            e.closed = here - below < properties_.hysteresis ? Closed::below : Closed::none;
            e.furthest = below;
            const bool within = forward_way(e.begin, here.angle()) < e.width;
            e.must_leave = is_open_end(e) && !within;
        }
    }

    // Reopens a crossing once the shaft is far enough away.
    constexpr void track(Edge& e, ShaftPosition here) noexcept TAPPET_REALTIME {
        if (e.closed == Closed::below) {
            if (here - e.below >= properties_.hysteresis)
                e.closed = Closed::none;
            else if (here - e.furthest > Rotation{})
                e.furthest = here - e.below > Rotation{} ? e.below : here;
        } else if (e.closed == Closed::above) {
            const ShaftPosition top = above(e);
            if (top - here >= properties_.hysteresis)
                e.closed = Closed::none;
            else if (e.furthest - here > Rotation{})
                e.furthest = top - here > Rotation{} ? top : here;
        }
    }

    // Plans the next crossing of an edge and its time. A crossing without an event is only recorded.
    void plan(Edge& e) noexcept TAPPET_REALTIME {
        const ShaftPosition here = motion_.state.position;
        const Time now = motion_.stamp;
        e.due = never;
        if (e.must_leave) {
            e.due = now;
            return;
        }
        const ShaftPosition up = e.closed == Closed::above ? e.furthest + properties_.hysteresis : above(e);
        const ShaftPosition down = e.closed == Closed::below ? e.furthest - properties_.hysteresis : e.below;
        const double v = motion_.state.velocity_deg_s;
        const bool over = here - up >= Rotation{};
        const bool under = down - here >= Rotation{};
        if (!over && !under && v == 0.0) return;
        e.side = over || (!under && v > 0.0) ? 1 : -1;
        const bool passed = over || under;
        const ShaftPosition target = e.side > 0 ? up : down;
        if (!passed && (e.side > 0 ? target - reach_ : reach_ - target) > Rotation{}) return;
        const bool slow = v == 0.0 || (v < 0.0 ? -v : v) < e.min_speed_deg_s;
        const CamKind what = kind(e, e.side);
        // Leaving is always planned: its window may be entered first.
        if (what != CamKind::leave && (slow || !allows(e, e.side))) {
            if (!passed) return;
            if (allows(e, e.side)) ++counters_.skipped_slow;
            cross(e, 1);
        } else if (passed) {
            e.due = now;
        } else {
            const Time crossing = motion_.when(target);
            // Within its hysteresis, a crossing fires at `target`, without dead-time compensation.
            e.due = crossing == never || !open_ahead(e) ? crossing : crossing - dead(e);
        }
    }

    void cross(Edge& e, std::int64_t turns) noexcept TAPPET_REALTIME {
        const ShaftPosition here = motion_.state.position;
        if (e.side > 0) {
            e.below = e.below + Rotation::turns(turns);
            e.closed = Closed::below;
            e.furthest = here - e.below > Rotation{} ? e.below : here;
        } else {
            e.below = e.below - Rotation::turns(turns);
            e.closed = Closed::above;
            e.furthest = above(e) - here > Rotation{} ? above(e) : here;
        }
        track(e, here);
    }

    [[nodiscard]] std::size_t first_due(Time now, bool forward) const noexcept TAPPET_REALTIME {
        const ShaftPosition here = motion_.state.position;
        std::size_t first = 0;
        Rotation least = Rotation::units(std::numeric_limits<std::int64_t>::max());
        for (std::size_t i = 0; i < used_; ++i) {
            const Edge& e = edges_[i];
            if (e.due > now) continue;
            const Rotation way = forward ? above(e) - here : here - e.below;
            // At one angle the order of the edges applies, from last to first when turning backward.
            if (way < least || (way == least && !forward)) {
                least = way;
                first = i;
            }
        }
        return first;
    }

    template <class Fire> void leave(Edge& e, Fire& fire) noexcept TAPPET_REALTIME {
        CamEvent event;
        event.row = e.row;
        event.kind = CamKind::leave;
        event.forced = true;
        event.position = event.target = event.effect = motion_.state.position;
        e.must_leave = false;
        inside_[e.row] = false;
        ++counters_.forced;
        fire(std::as_const(event));
    }

    template <class Fire> void serve(Edge& e, Fire& fire) noexcept TAPPET_REALTIME {
        if (e.must_leave) {
            leave(e, fire);
            plan(e);
            return;
        }
        CamEvent event;
        event.row = e.row;
        event.position = motion_.state.position;
        event.kind = kind(e, e.side);
        event.forward = e.side > 0;
        event.target = e.side > 0 ? above(e) : e.below;
        event.effect = motion_.at(motion_.stamp + dead(e)).position;
        const Rotation after = event.forward ? event.effect - event.target : event.target - event.effect;
        event.late_deg = after.in_degrees();
        const std::int64_t turns = after > Rotation{} ? 1 + (after.in_units() >> 32) : 1;
        cross(e, turns);
        const bool leaving = event.kind == CamKind::leave;
        if (!leaving && after > properties_.skip_from) {
            counters_.skipped_late += static_cast<std::uint64_t>(turns);
        } else if (!leaving || inside_[e.row]) {
            if (event.kind != CamKind::point) inside_[e.row] = !leaving;
            ++counters_.fired;
            if (after >= properties_.late_from) ++counters_.late;
            counters_.latest_deg = std::max(counters_.latest_deg, event.late_deg);
            fire(std::as_const(event));
        }
        plan(e);
    }

    CamProperties properties_;
    std::array<Edge, 2 * N> edges_{};
    std::size_t used_ = 0;
    std::array<bool, N> inside_{};
    Duration longest_dead_ = Duration::zero();
    ShaftMotion motion_;
    ShaftPosition reach_{}; // positions beyond it cannot be due before the motion is stale
    std::uint32_t epoch_ = 0;
    Time next_due_ = never;
    Time good_until_ = Time::min(); // of the motion
    bool started_ = false;
    CamCounters counters_;
};

template <std::size_t N> CamSchedule(const CamTable<N>&) -> CamSchedule<N>;
template <std::size_t N> CamSchedule(const CamTable<N>&, const CamProperties&) -> CamSchedule<N>;

} // namespace tappet

// The time service (thesis 3.3): an event at a time, after a delay, or periodically.
#pragma once

#include "kernel/component/component.hpp"

namespace tappet {

/// In the table: component<TimedEvent>("rinse"), when("panel.wash", tell("rinse.arm_after")) and
/// when("rinse.due", tell("pump.start")). Arming again moves the event; a past time is due at once; a period
/// that is not positive arms nothing. It wakes its activity, which is on_work() or not_real_time. A stop of
/// the component cancels it. Real-time.
struct TimedEvent {
    Event<Time> due;              ///< the time it was armed for
    Output<std::int64_t> times;   ///< how often it was due
    Output<std::int64_t> skipped; ///< periods that passed while its activity was late

    Sentence configure(Setup& setup) {
        clock_ = setup.clock;
        return {};
    }
    void start(const Cycle&) noexcept TAPPET_REALTIME {
        times.write(times.last());
        skipped.write(skipped.last());
    }

    void arm_at(Time when) noexcept TAPPET_REALTIME {
        period_ = Duration::zero();
        timer_.arm(when);
    }
    void arm_after(Duration after) noexcept TAPPET_REALTIME { arm_at(clock_->now() + after); }
    /// Emits the event first one period from now; later ones keep that rhythm, however late the activity
    /// runs.
    void every(Duration period) noexcept TAPPET_REALTIME {
        cancel();
        if (period <= Duration::zero()) return;
        arm_after(period);
        period_ = period;
    }
    void cancel() noexcept TAPPET_REALTIME { timer_.cancel(); }
    [[nodiscard]] bool armed() const noexcept TAPPET_REALTIME { return timer_.when() != never; }

    static constexpr auto interface() {
        return facets(event<&TimedEvent::due>("due", "the armed time is reached", heard_by(1)),
                      output<&TimedEvent::times>("times", "", "how often it was due"),
                      output<&TimedEvent::skipped>("skipped", "", "periods lost to lateness"),
                      operation<&TimedEvent::arm_at>("arm_at", "once, at this time"),
                      operation<&TimedEvent::arm_after>("arm_after", "once, after this time"),
                      operation<&TimedEvent::every>("every", "periodically, with this period"),
                      operation<&TimedEvent::cancel>("cancel", "it is not due any more"),
                      timer<&TimedEvent::timer_, &TimedEvent::ring>("timer", "wakes the activity"));
    }

private:
    void ring(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const Time when = cycle.release;
        if (period_ > Duration::zero()) {
            Time next = when + period_;
            if (next <= cycle.now) { // lost whole periods are counted, not repeated
                const auto lost = (cycle.now - next) / period_ + 1;
                skipped.write(skipped.last() + lost);
                next += lost * period_;
            }
            timer_.arm(next);
        }
        times.write(times.last() + 1);
        due(when); // last: its listener may arm it again
    }

    Timer timer_;
    Duration period_{};
    const os::Clock* clock_ = nullptr;
};

} // namespace tappet

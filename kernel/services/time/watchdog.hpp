// The time service (thesis 3.3): a watchdog reports when an activity, or the writer of a connection, shows no
// life for too long.
#pragma once

#include "kernel/component/component.hpp"

namespace tappet {

/// In the table: component<Watchdog>("motion_dog", watches("motion"), set("limit", 20ms)). `watches` names an
/// activity, or an output that another activity reads ("can.encoder.position"). The watchdog checks once in
/// each cycle of its own activity, which must be periodic and not the watched one: it reports silence after
/// the limit, never before it, and at most two of its own periods later. An activity shows life when a cycle
/// begins and when it ends, so an activity that hangs in a cycle becomes silent. Give the watchdog a shorter
/// deadline than the watched activity, or another processor, so that a hanging activity cannot keep it from
/// checking. A target that was stopped by a request is not expected to live; the limit restarts when it
/// starts. An activity without a period is silent when it does not begin or end the work it was woken for, or
/// that was due: a timer, or the check of an input that becomes stale. Real-time.
struct Watchdog {
    static constexpr bool watches_life = true;

    Output<bool> alive;     ///< written on change
    Event<Duration> silent; ///< once in each silence, with its duration so far
    Event<Duration> revived;
    Property<Duration> limit{100ms};

    Sentence configure(Setup& setup) {
        sign_ = setup.watched;
        return {};
    }
    void start(const Cycle& cycle) noexcept TAPPET_REALTIME {
        count_ = sign_.count(sign_.watched);
        last_life_ = cycle.now;
        silent_ = false;
        rested_ = sign_.rests != nullptr;
        alive.write(true);
    }
    void step(const Cycle& cycle) noexcept TAPPET_REALTIME {
        const std::uint64_t count = sign_.count(sign_.watched);
        const bool lives = count != count_;
        const Duration silence = cycle.now - last_life_;
        count_ = count;
        const bool rests = sign_.rests != nullptr && sign_.rests(sign_.owner, cycle.now);
        // An activity that rested at the last check may have been woken just now.
        if (lives || rests || rested_ || !sign_.expected(sign_.owner)) last_life_ = cycle.now;
        rested_ = rests;
        if (lives && silent_) {
            silent_ = false;
            revived(silence);
        } else if (!lives && !silent_ && cycle.now - last_life_ >= limit.get()) {
            silent_ = true;
            silent(silence);
        }
        if (alive.last() == silent_) alive.write(!silent_);
    }

    static constexpr auto interface() {
        return facets(
            output<&Watchdog::alive>("alive", "",
                                     "what it watches has shown life within the limit; written on change",
                                     while_stopped(false)),
            event<&Watchdog::silent>("silent", "no life for longer than the limit; how long"),
            event<&Watchdog::revived>("revived", "life again after a silence; how long that was"),
            property<&Watchdog::limit>("limit", "s", "the longest time without life", range(1e-6, 3600)));
    }

private:
    LifeSign sign_{};
    std::uint64_t count_ = 0;
    Time last_life_{};
    bool silent_ = false, rested_ = false; ///< at the last check
};

} // namespace tappet

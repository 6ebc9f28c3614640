// The machines as switches, written by hand.
#include "tests/figures/behaviour/by_hand.hpp"

#include "tests/figures/behaviour/steps.hpp"

namespace tappet::figures {

template <Records records>
bool HandLoom<records>::switch_over(std::size_t event, Time now) noexcept TAPPET_REALTIME {
    switch (state) {
    case off:
        switch (event) {
        case power: return go(leave() && enter_on(now), idle, now);
        default: return false;
        }
    case idle:
        switch (event) {
        case start: return counts.picks >= 0 && go(leave() && enter_weaving(now), slow, now);
        case broken: return go(leave() && leave() && enter(outer, now), fault, now);
        case power: return go(leave() && leave() && enter(outer, now), off, now);
        default: return false;
        }
    case slow:
    case fast:
        switch (event) {
        case faster: return state == slow && counts.picks >= 0 && go(leave() && enter(inner, now), fast, now);
        case slower: return state == fast && go(leave() && enter(inner, now), slow, now);
        case stop: return go(leave_weaving() && enter(middle, now), idle, now);
        case pick: return go(add(counts.picks), state, now);
        case broken: return go(leave_weaving() && leave() && enter(outer, now), fault, now);
        case power: return go(leave_weaving() && leave() && enter(outer, now), off, now);
        default: return false;
        }
    case fault:
        switch (event) {
        case reset: return go(leave() && enter_on(now), idle, now);
        case power: return go(leave() && enter(outer, now), off, now);
        default: return false;
        }
    case safe: break;
    }
    return false;
}

template <Records records>
bool HandLoom<records>::dispatch(std::size_t event, Time now) noexcept TAPPET_REALTIME {
    if constexpr (!kept) return switch_over(event, now);
    if (kept_.busy || kept_.overflowed) {
        ++kept_.waiting;
        return false;
    }
    kept_.busy = true;
    const bool taken = switch_over(event, now);
    kept_.busy = false;
    return taken;
}
template class HandLoom<Records::none>;
template class HandLoom<Records::kept>;

bool HandSwing::beat(State to, Time now) noexcept TAPPET_REALTIME {
    if (__builtin_add_overflow(runs, 2, &runs)) return fails();
    if (__builtin_add_overflow(exits, 1, &exits)) return fails();
    if (__builtin_add_overflow(entries, 1, &entries)) return fails();
    const State from = state;
    state = to;
    entered_at_ = now;
    kept_.taken(from, to, now);
    return true;
}

bool HandSwing::dispatch(std::size_t event, Time now) noexcept TAPPET_REALTIME {
    if (kept_.busy || kept_.overflowed) {
        ++kept_.waiting;
        return false;
    }
    kept_.busy = true;
    bool taken = false;
    switch (state) {
    case left:
        switch (event) {
        case 0:
            if (runs >= 0) taken = beat(right, now);
            break;
        default: break;
        }
        break;
    case right:
        switch (event) {
        case 0:
            if (runs >= 0) taken = beat(left, now);
            break;
        default: break;
        }
        break;
    case safe: break;
    }
    kept_.busy = false;
    return taken;
}

void HandSwing::step(Time now) noexcept TAPPET_REALTIME {
    if (kept_.busy || kept_.overflowed) return;
    kept_.busy = true;
    kept_.stepped_at = now;
    switch (state) {
    case left:
    case right:
        if (__builtin_add_overflow(runs, 1, &runs)) {
            static_cast<void>(fails());
            return;
        }
        if (runs < 0) {
            const State from = state;
            state = safe;
            entered_at_ = now;
            kept_.taken(from, safe, now);
        }
        break;
    case safe: break;
    }
    kept_.busy = false;
}

void HandRelay::step(Time now) noexcept TAPPET_REALTIME {
    if (kept_.busy || kept_.overflowed) return;
    kept_.busy = true;
    kept_.stepped_at = now;
    if (due == 1) {
        due = 0;
        kept_.overflowed = __builtin_add_overflow(turns, 1, &turns);
        kept_.taken(right_, !right_, now);
        right_ = !right_;
        entered_at_ = now;
    }
    if (due == 0) due = 1; // the entered state handles it
    kept_.busy = false;
}

void HandClock::step(Time now) noexcept TAPPET_REALTIME {
    if (kept_.busy || kept_.overflowed) return;
    kept_.busy = true;
    kept_.stepped_at = now;
    if (now - entered_at_ >= period) {
        kept_.overflowed = __builtin_add_overflow(turns, 1, &turns);
        kept_.taken(right_, !right_, now);
        right_ = !right_;
        entered_at_ = now;
    }
    kept_.busy = false;
}

bool HandSums::run() noexcept TAPPET_REALTIME {
    for (;;) {
        switch (position) {
        case 0:
            if (i >= turns_of_sums) {
                position = 1;
                return true;
            }
            if (__builtin_add_overflow(i, 1, &i)) return false;
            if (__builtin_add_overflow(a, i, &a)) return false;
            if (__builtin_sub_overflow(a, b, &b)) return false;
            if (b > 100000) b = 1;
            x = x + 0.5;
            x = x * 0.75;
            if (__builtin_sub_overflow(a, b, &a)) return false;
            break;
        default: return true;
        }
    }
}

} // namespace tappet::figures

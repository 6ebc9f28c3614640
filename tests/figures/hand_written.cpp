// The behaviours as switches, written by hand.
#include "tests/figures/behaviours.hpp"

namespace tappet::figures {

bool HandWritten::beat(State to, Time now) noexcept TAPPET_REALTIME {
    if (__builtin_add_overflow(runs, 2, &runs)) return fails();
    if (__builtin_add_overflow(exits, 1, &exits)) return fails();
    if (__builtin_add_overflow(entries, 1, &entries)) return fails();
    const State from = state;
    state = to;
    entered_at_ = now;
    last_ = from;
    ++transitions_;
    if (trace_ != nullptr) trace_(trace_context_, from, to, now);
    return true;
}

bool HandWritten::dispatch(std::size_t event, Time now) noexcept TAPPET_REALTIME {
    if (busy_ || fault_ != none) {
        ++waiting_;
        return false;
    }
    busy_ = true;
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
    busy_ = false;
    return taken;
}

void HandWritten::step(Time now) noexcept TAPPET_REALTIME {
    if (busy_ || fault_ != none) return;
    busy_ = true;
    stepped_at_ = now;
    switch (state) {
    case left:
    case right:
        if (__builtin_add_overflow(runs, 1, &runs)) {
            static_cast<void>(fails());
            return;
        }
        if (runs < 0) {
            state = safe;
            entered_at_ = now;
            ++transitions_;
        }
        break;
    case safe: break;
    }
    busy_ = false;
}

bool HandWrittenSums::run() noexcept TAPPET_REALTIME {
    for (;;) {
        switch (position) {
        case 0:
            if (i >= 1000) {
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

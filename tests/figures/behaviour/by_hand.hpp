// The machines as switches, written by hand. `Records::kept` adds the records that the framework keeps:
// checked sums, times of entry, the last transition, a trace, one event at a time.
#pragma once

#include "tests/figures/behaviour/loom.hpp"

namespace tappet::figures {

enum class Records : std::uint8_t { none, kept };

/// The records of a machine beside its state.
struct HandRecords {
    using Trace = void (*)(void*, int from, int to, Time now) noexcept TAPPET_REALTIME;
    bool busy = false;
    bool overflowed = false;
    std::uint32_t waiting = 0;
    std::uint16_t last = 0;
    std::uint64_t transitions = 0;
    Time stepped_at{};
    Trace trace = nullptr;
    void* trace_context = nullptr;

    void taken(int from, int to, Time now) noexcept TAPPET_REALTIME {
        last = static_cast<std::uint16_t>(from);
        ++transitions;
        if (trace != nullptr) trace(trace_context, from, to, now);
    }
};

template <Records records> class HandLoom {
public:
    enum State : std::uint16_t { off, idle, slow, fast, fault, safe };

    [[gnu::noinline]] bool dispatch(std::size_t event, Time now) noexcept TAPPET_REALTIME;

    LoomCounts counts{0, 1, 0};
    State state = off;

private:
    static constexpr bool kept = records == Records::kept;
    enum Level : std::uint8_t { outer, middle, inner };

    bool add(std::int64_t& sum) noexcept TAPPET_REALTIME {
        if constexpr (!kept) {
            ++sum;
            return true;
        } else
            return !__builtin_add_overflow(sum, 1, &sum);
    }
    bool leave() noexcept TAPPET_REALTIME { return add(counts.exits); }
    bool enter(Level level, Time now) noexcept TAPPET_REALTIME {
        if constexpr (kept) entered_at_[level] = now;
        return add(counts.entries);
    }
    bool leave_weaving() noexcept TAPPET_REALTIME { return leave() && leave(); }
    bool enter_on(Time now) noexcept TAPPET_REALTIME { return enter(outer, now) && enter(middle, now); }
    bool enter_weaving(Time now) noexcept TAPPET_REALTIME { return enter(middle, now) && enter(inner, now); }
    bool go(bool done, State to, Time now) noexcept TAPPET_REALTIME {
        if constexpr (kept) {
            if (!done) {
                kept_.overflowed = true;
                return false;
            }
            kept_.taken(state, to, now);
        }
        state = to;
        return true;
    }
    bool switch_over(std::size_t event, Time now) noexcept TAPPET_REALTIME;

    HandRecords kept_;
    std::array<Time, 3> entered_at_{};
};

/// Two states; a run program in each, and a condition that never holds.
class HandSwing {
public:
    enum State : std::uint16_t { left, right, safe };
    [[gnu::noinline]] bool dispatch(std::size_t event, Time now) noexcept TAPPET_REALTIME;
    [[gnu::noinline]] void step(Time now) noexcept TAPPET_REALTIME;

    std::int64_t exits = 0, entries = 1, runs = 0;
    State state = left;

private:
    bool beat(State to, Time now) noexcept TAPPET_REALTIME;
    bool fails() noexcept TAPPET_REALTIME {
        kept_.overflowed = true;
        kept_.busy = false;
        return false;
    }
    HandRecords kept_;
    Time entered_at_{};
};

/// Two states; a condition changes them once in each step.
class HandRelay {
public:
    [[gnu::noinline]] void step(Time now) noexcept TAPPET_REALTIME;
    std::int64_t turns = 0, due = 1;

private:
    bool right_ = false;
    HandRecords kept_;
    Time entered_at_{};
};

/// Two states that alternate by time-outs.
class HandClock {
public:
    static constexpr Duration period = std::chrono::milliseconds{1};
    [[gnu::noinline]] void step(Time now) noexcept TAPPET_REALTIME;
    std::int64_t turns = 0;

private:
    bool right_ = false;
    HandRecords kept_;
    Time entered_at_ = at_ns(0);
};

/// The loop of sums.osd, as a program that keeps its variables and its position.
struct HandSums {
    std::int64_t i = 0, a = 0, b = 1;
    double x = 0;
    int position = 0;
    [[gnu::noinline]] bool run() noexcept TAPPET_REALTIME;
};

} // namespace tappet::figures

// The machine whose calls are measured: an emitter and its senders in one activity, the listeners in others.
// Its table binds everything.
#pragma once

#include "kernel/activity/engine.hpp"
#include "kernel/machine/table/machine.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace tappet::figures {

inline constexpr std::size_t listeners = 64;
inline constexpr std::size_t senders = 32;

/// Does the smallest visible work: the callee is the same for ours, floors and peers.
struct Listener {
    double sum = 0;

    void hear(double value) noexcept TAPPET_REALTIME { sum += value; }
    bool note(double value) noexcept TAPPET_REALTIME {
        sum += value;
        return true;
    }
    double scaled(double value) const noexcept TAPPET_REALTIME { return value * sum; }
    static constexpr auto interface() {
        return facets(operation<&Listener::hear>("hear", "adds", any_thread),
                      command<&Listener::note>("note", "adds"),
                      method<&Listener::scaled>("scaled", "by the sum", any_thread));
    }
};

struct Emitter {
    Event<double> none, one, two, eight, many;               ///< that many rows call
    Event<double> tell_one, tell_two, tell_eight, tell_many; ///< that many rows notify another activity
    Event<double> changing;                                  ///< one row calls, one notifies
    EventHandle calling, telling;                            ///< of those two rows
    MethodCall<double(double)> scaled;

    static constexpr auto interface() {
        return facets(event<&Emitter::none>("none", "nobody"), event<&Emitter::one>("one", "one"),
                      event<&Emitter::two>("two", "two"), event<&Emitter::eight>("eight", "eight"),
                      event<&Emitter::many>("many", "all"), event<&Emitter::tell_one>("tell_one", "one"),
                      event<&Emitter::tell_two>("tell_two", "two"),
                      event<&Emitter::tell_eight>("tell_eight", "eight"),
                      event<&Emitter::tell_many>("tell_many", "all"),
                      event<&Emitter::changing>("changing", "rows that come and go"),
                      handle<&Emitter::calling>("calling", "of a synchronous row"),
                      handle<&Emitter::telling>("telling", "of an asynchronous row"),
                      calls<&Emitter::scaled>("scaled", "of a listener"));
    }
};

struct Sender {
    CommandCall<double> note;    ///< to an activity that is woken for it
    CommandCall<double> clocked; ///< to one that polls every period
    static constexpr auto interface() {
        return facets(sends<&Sender::note>("note", "adds"), sends<&Sender::clocked>("clocked", "adds"));
    }
};

/// The machine, configured and started; the measuring program runs every engine.
struct Measured {
    Emitter* emitter = nullptr;
    std::array<Sender*, senders> sender{};
    std::array<Listener*, listeners> listener{};
    Engine* far = nullptr;     ///< of the listeners; it is woken
    Engine* clocked = nullptr; ///< of one more listener; it is periodic
};
Measured& measured(); ///< in virtual time
Measured& measured_with_stamps();

} // namespace tappet::figures

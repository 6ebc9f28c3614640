// The operator of the loom: watches lamps and shaft, repairs faults, acknowledges, and presses start.
#pragma once

#include "apps/carpet_loom/plant/settings.hpp"
#include "kernel/base/realtime.hpp"

namespace tappet::loom {

class Operator {
public:
    static constexpr Duration period = 10ms; // the operator looks this often
    static constexpr Duration press = 150ms;
    static constexpr Duration patience = 2s; // then the operator retries the same action

    struct Sight {
        bool lamp_run, lamp_stop, lamp_fault;
        bool standing; // the shaft
        bool broken;   // a repair is needed
        bool finished; // the order is woven
    };
    enum class Action : std::uint8_t { none, repair, acknowledge, start };

    explicit constexpr Operator(Duration reaction) noexcept TAPPET_REALTIME : reaction_(reaction) {}

    Action look(const Sight& sight, Time now) noexcept TAPPET_REALTIME {
        const Action wanted = what_to_do(sight);
        if (wanted != wanted_) {
            wanted_ = wanted;
            due_ = now + hesitation(wanted);
        }
        if (wanted == Action::none || now < due_) return Action::none;
        due_ = now + patience;
        return wanted;
    }

private:
    static Action what_to_do(const Sight& sight) noexcept TAPPET_REALTIME {
        if (!sight.standing) return Action::none;
        if (sight.broken) return Action::repair;
        if (sight.lamp_fault) return Action::acknowledge;
        return sight.lamp_stop && !sight.lamp_run && !sight.finished ? Action::start : Action::none;
    }
    [[nodiscard]] Duration hesitation(Action action) const noexcept TAPPET_REALTIME {
        return action == Action::repair ? reaction_ : reaction_ / 5;
    }

    Duration reaction_;
    Action wanted_ = Action::none;
    Time due_{};
};

} // namespace tappet::loom

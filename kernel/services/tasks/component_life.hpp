// The life of another component as commands (thesis 3.1.3), so that rows and scripts may start and stop it.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/machine/instance/controlled.hpp"
#include "kernel/machine/instance/life.hpp"

namespace tappet {

/// In the table: component<ComponentLife>("printing", controls("printer")); `do printing.stop()` in a script,
/// uses("console.stop_printer", "printing.stop") in a row. The component may run in any activity. The command
/// is done when the component has answered, and failed when it refuses or another change was requested
/// meanwhile. The activity of this component must be periodic. Real-time.
struct ComponentLife {
    static constexpr auto controls = ComponentType::Controls::life;
    void control(const Controlled& controlled) noexcept { controlled_ = controlled; }

    bool start_it() noexcept TAPPET_REALTIME { return asks(LifeChange::start); }
    bool stop_it() noexcept TAPPET_REALTIME { return asks(LifeChange::stop); }
    bool restart_it() noexcept TAPPET_REALTIME { return asks(LifeChange::restart); }
    template <LifeChange change> CommandProgress is_done() noexcept TAPPET_REALTIME {
        switch (controlled_.life->answer_of_component(controlled_.component, ticket(change)).outcome) {
        case LifeOutcome::pending: return CommandProgress::executing;
        case LifeOutcome::done: return CommandProgress::done;
        case LifeOutcome::refused:
        case LifeOutcome::superseded: break;
        }
        return CommandProgress::failed;
    }
    bool runs() noexcept TAPPET_REALTIME {
        return controlled_.life->state_of(controlled_.component) == ComponentState::running;
    }

    static constexpr auto interface() {
        return facets(command<&ComponentLife::start_it, &ComponentLife::is_done<LifeChange::start>>(
                          "start", "from its safe values"),
                      command<&ComponentLife::stop_it, &ComponentLife::is_done<LifeChange::stop>>(
                          "stop", "to its safe values"),
                      command<&ComponentLife::restart_it, &ComponentLife::is_done<LifeChange::restart>>(
                          "restart", "to its safe values, then from them"),
                      method<&ComponentLife::runs>("is_running", "steps and messages reach it", any_thread));
    }

private:
    bool asks(LifeChange change) noexcept TAPPET_REALTIME {
        ticket(change) = controlled_.life->ask_component(controlled_.component, change);
        return true;
    }

    LifeTicket& ticket(LifeChange change) noexcept TAPPET_REALTIME {
        return tickets_[static_cast<std::size_t>(change)];
    }

    Controlled controlled_{};
    std::array<LifeTicket, 3> tickets_{}; ///< the last request of each change
};

} // namespace tappet

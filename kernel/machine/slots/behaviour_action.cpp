// Carries out an action on a behaviour, be it a program or a state machine.
#include "kernel/machine/slots/behaviour_action.hpp"

namespace tappet {

namespace {

bool act(StateMachineExecution& machine, BehaviourAction action, StateIndex state, Time now) noexcept
    TAPPET_REALTIME {
    switch (action) {
    case BehaviourAction::start: return machine.start(now) != StateOutcome::ignored;
    case BehaviourAction::stop:
        return machine.request_final(now, "requested from outside") != StateOutcome::ignored;
    case BehaviourAction::pause: return machine.pause() != StateOutcome::ignored;
    case BehaviourAction::step: return machine.step_once(now);
    case BehaviourAction::reset: return machine.request_initial(now) != StateOutcome::ignored;
    case BehaviourAction::deactivate: return machine.deactivate(now) != StateOutcome::ignored;
    case BehaviourAction::reactive: return machine.reactive() != StateOutcome::ignored;
    case BehaviourAction::request: {
        const StateOutcome outcome = machine.request_state(state, now);
        return outcome != StateOutcome::ignored && outcome != StateOutcome::lost;
    }
    }
    return false;
}

bool act(ProgramExecution& program, BehaviourAction action, Time now) noexcept TAPPET_REALTIME {
    switch (action) {
    case BehaviourAction::start: return program.start();
    case BehaviourAction::stop: return program.stop();
    case BehaviourAction::pause: return program.pause();
    case BehaviourAction::step: return program.single_step(now);
    case BehaviourAction::reset: return program.reset();
    case BehaviourAction::deactivate:
    case BehaviourAction::reactive:
    case BehaviourAction::request: return false;
    }
    return false;
}

} // namespace

bool act(BehaviourUnit& unit, UnitPart& part, BehaviourAction action, StateIndex state, Time now) noexcept
    TAPPET_REALTIME {
    if (!unit.component_runs()) return false;
    const bool ends = action == BehaviourAction::stop || action == BehaviourAction::deactivate;
    if (!unit.may_begin() && !ends && action != BehaviourAction::pause) return false;
    const bool acts =
        part.machine != nullptr ? act(*part.machine, action, state, now) : act(*part.program, action, now);
    if (acts && ends) part.begins_anew = false;
    return acts;
}

} // namespace tappet

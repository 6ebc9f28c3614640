// The life cycle of an engine's components (thesis 3.1.3): all start and stop with their activity, or one
// starts or stops while the others run. A component starts with valid inputs and leaves safe values.
#include "kernel/activity/engine.hpp"

namespace tappet {

namespace {

/// Returns the reason why this input prevents the start of its component, or `none` if it does not.
LifeRefusal refusal_by(const NeededInput& input) noexcept TAPPET_REALTIME {
    if (input.circle != nullptr && !is_running(*input.circle)) return LifeRefusal::none;
    const Flow flow = input.flow(input.input);
    if (flow == Flow::stale) return LifeRefusal::input_stale;
    const bool is_missing = flow == Flow::never_written && !input.has_initial && input.circle == nullptr;
    return is_missing ? LifeRefusal::input_never_written : LifeRefusal::none;
}

constexpr std::uint64_t life_note = 0x6c696665u; // "life": no transition of a state machine has this number

/// Returns the first begin of a period after `now`. All periods count from the beginning of the clock.
constexpr Time next_on_grid(Time now, Duration period, Duration phase) noexcept TAPPET_REALTIME {
    const Duration since = now - (Time{} + phase);
    const auto whole = since / period - (since % period < Duration::zero() ? 1 : 0);
    return Time{} + phase + (whole + 1) * period;
}
static_assert(next_on_grid(Time{} + 1ms, 1ms, 0ms) == Time{} + 2ms &&
                  next_on_grid(Time{}, 1ms, 200us) == Time{} + 200us &&
                  next_on_grid(Time{} + 1700us, 1ms, 200us) == Time{} + 2200us,
              "the next point lies after now, by a period at most");

/// Gives each port of this kind, with its facet, to visit(facet, port).
template <class Visit>
void for_ports(const ComponentType& type, void* component, FacetKind kind, Visit&& visit) noexcept
    TAPPET_REALTIME {
    for (const Facet& each : type.facets) {
        if (each.kind != kind) continue;
        void* port = nullptr;
        TAPPET_ESCAPE("computes an address", port = each.at(component, each.index));
        visit(each, port);
    }
}

void close(const ComponentType& type, void* component, DroppedWrites* counter) noexcept TAPPET_REALTIME {
    for_ports(type, component, FacetKind::output,
              [&](const Facet& facet, void* port) noexcept
              TAPPET_REALTIME { facet.port->close(port, counter); });
    for_ports(type, component, FacetKind::buffer_output,
              [&](const Facet& facet, void* port) noexcept
              TAPPET_REALTIME { facet.buffer->close(port, counter); });
}

} // namespace

Sentence Engine::initialise() {
    expect_standing();
    const RunsActivity here{plan_.activity, &cycle_.now}; // activity not running: this thread may emit for it
    for (std::size_t i = 0; i < plan_.parts.size(); ++i) {
        EnginePart& part = plan_.parts[i];
        if (part.type->initialise != nullptr)
            if (const Sentence refusal = part.type->initialise(part.component_); !refusal.empty()) {
                part.state.store(ComponentState::failed, std::memory_order_release);
                while (i-- > 0)
                    if (plan_.parts[i].type->finalise != nullptr)
                        plan_.parts[i].type->finalise(plan_.parts[i].component_);
                return Sentence{"component \"", part.name, "\" could not be initialised: ", refusal};
            }
        if (part.state.load(std::memory_order_relaxed) == ComponentState::failed)
            part.state.store(ComponentState::stopped, std::memory_order_release);
    }
    return {};
}

void Engine::finalise() {
    expect_standing();
    const RunsActivity here{plan_.activity, &cycle_.now};
    for (std::size_t i = plan_.parts.size(); i-- > 0;)
        if (plan_.parts[i].type->finalise != nullptr)
            plan_.parts[i].type->finalise(plan_.parts[i].component_);
}

void Engine::start(Time now) noexcept TAPPET_REALTIME {
    const std::uint64_t generation = begin_change();
    const RunsActivity here{plan_.activity, &cycle_.now};
    stamps_.renew();
    cycle_.now = cycle_.release = lap_ = ended_ = now;
    next_release_ = plan_.periodic ? next_on_grid(now, plan_.period, plan_.phase) : never;
    if (was_stopped_) {
        static_cast<void>(run_messages()); // drops messages posted since the stop; each row counts its own
        commands_.reject_sent();
    }
    asked_.store(true, std::memory_order_relaxed);
    serve_requests(); // refuses all: not active yet, and answer_to() has already reported them as refused
    active_.store(true, std::memory_order_release);
    awaiting_ = 0;
    // First set all states, so that a message sent in one start() reaches components that start later.
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i)
        if (plan_.parts[i].state.load(std::memory_order_relaxed) != ComponentState::failed)
            plan_.parts[i].state.store(may_wait(i) ? ComponentState::waiting : ComponentState::starting,
                                       std::memory_order_release);
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        if (plan_.parts[i].state.load(std::memory_order_relaxed) == ComponentState::failed) continue;
        if (rests(i))
            plan_.parts[i].state.store(ComponentState::stopped, std::memory_order_release);
        else if (check_inputs(i, Rule::with_the_machine).refusal == LifeRefusal::none)
            start_part(i);
        else
            ++awaiting_;
    }
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) start_behaviours(i);
    if (!plan_.periodic)
        for (GuardedInput& each : plan_.guarded)
            each.expires = now; // the first check sets the time of the next one
    end_change(generation);
}

void Engine::stop_behaviours(std::uint32_t part) noexcept TAPPET_REALTIME {
    if (!is_running(plan_.parts[part].state) || plan_.parts[part].ends_at != never) return;
    for (const Behaviour& each : plan_.behaviours)
        if (each.part == part) each.stop(each.self, cycle_.now);
}

bool Engine::have_ended(std::uint32_t part) const noexcept TAPPET_REALTIME {
    if (!is_running(plan_.parts[part].state)) return true;
    for (const Behaviour& each : plan_.behaviours)
        if (each.part == part && !each.has_ended(each.self)) return false;
    return true;
}

// Messages sent before the stop are handled first.
void Engine::begin_end(Time now, Time until) noexcept TAPPET_REALTIME {
    const std::uint64_t generation = begin_change();
    const RunsActivity here{plan_.activity, &cycle_.now};
    stamps_.renew();
    cycle_.now = cycle_.release = lap_ = now;
    static_cast<void>(run_messages());
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        stop_behaviours(i);
        refuse_ending(i);
    }
    ends_at_ = std::min(now + end_limit, until);
    end_change(generation);
}

bool Engine::has_ended(Time now) const noexcept TAPPET_REALTIME {
    if (now >= ends_at_) return true;
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i)
        if (!have_ended(i)) return false;
    return true;
}

void Engine::stop(Time now) noexcept TAPPET_REALTIME {
    const std::uint64_t generation = begin_change();
    const RunsActivity here{plan_.activity, &cycle_.now};
    stamps_.renew();
    cycle_.now = cycle_.release = lap_ = now;
    // Messages that were sent before the stop are handled, and also those that the engine's own behaviours
    // send when they end: so a requested closing of a valve is still done. If a contract broke in the cycle,
    // the mailbox itself may be broken, so it is left alone.
    const bool broke = generation == is_changing;
    if (!broke) static_cast<void>(run_messages());
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        if (ends_at_ == never) stop_behaviours(i);
        refuse_ending(i);
    }
    ends_at_ = never;
    if (!broke) static_cast<void>(run_messages());
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        stop_part(i);
        plan_.parts[i].waits_for_its_turn.store(false, std::memory_order_relaxed);
    }
    if (recorder_ != nullptr && !broke) recorder_->record(*recorder_, cycle_, false);
    commands_.reject_sent();
    awaiting_ = 0;
    was_stopped_ = true;
    active_.store(false, std::memory_order_release);
    end_change(generation);
}

void Engine::reject_late() noexcept TAPPET_REALTIME {
    if (!is_active()) commands_.reject_sent();
}

void Engine::start_part(std::uint32_t i) noexcept TAPPET_REALTIME {
    EnginePart& part = plan_.parts[i];
    part.state.store(ComponentState::starting, std::memory_order_release);
    open_outputs(part);
    for_ports(*part.type, part.component_, FacetKind::input,
              [](const Facet& facet, void* port) noexcept TAPPET_REALTIME { facet.port->resume(port); });
    cancel_timers(i); // those that changed() armed while the component was stopped
    if (part.type->start != nullptr) part.type->start(part.component_, cycle_);
    part.state.store(ComponentState::running, std::memory_order_release);
}

void Engine::end_forces(const EnginePart& part, FacetKind of) const noexcept TAPPET_REALTIME {
    const bool is_input = of == FacetKind::input;
    for_ports(*part.type, part.component_, of, [&](const Facet& facet, void* port) noexcept TAPPET_REALTIME {
        if (!*facet.port->places(port, is_input).forced) return;
        facet.port->end_force(port, is_input);
        if (plan_.forced != nullptr) plan_.forced->fetch_sub(1, std::memory_order_relaxed);
    });
}

void Engine::begin_life(const EnginePart& part) noexcept TAPPET_REALTIME {
    const Life next = life_after(part.stops.count.load(std::memory_order_relaxed));
    for_ports(*part.type, part.component_, FacetKind::output,
              [next](const Facet& facet, void* port) noexcept
              TAPPET_REALTIME { facet.port->begin_life(port, next); });
}

void Engine::tell_resting() noexcept TAPPET_REALTIME {
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i)
        plan_.parts[i].waits_for_its_turn.store(rests(i), std::memory_order_relaxed);
}

// The engine writes these values, so that no driver's stop() has to.
void Engine::say_at_rest(const EnginePart& part) noexcept TAPPET_REALTIME {
    for_ports(*part.type, part.component_, FacetKind::output,
              [](const Facet& facet, void* port) noexcept TAPPET_REALTIME {
                  if (facet.at_rest < AtRest::says_false) return;
                  const bool says = facet.at_rest == AtRest::says_true;
                  facet.port->write(port, reinterpret_cast<const std::byte*>(&says));
              });
}

void Engine::open_outputs(EnginePart& part) noexcept TAPPET_REALTIME {
    close(*part.type, part.component_, nullptr);
}

// Counts first: close() wakes readers, and a forced reader must then see that its force has ended.
void Engine::close_outputs(EnginePart& part, std::uint64_t stop) noexcept TAPPET_REALTIME {
    part.stops.count.fetch_add(stop, std::memory_order_seq_cst);
    close(*part.type, part.component_, &part.dropped_writes);
}

void Engine::cancel_timers(std::uint32_t part) noexcept TAPPET_REALTIME {
    for (const EngineTimer& each : plan_.timers)
        if (each.part == part) each.timer->cancel();
}

// A component that failed or stopped before has already left its safe values. The forces of its inputs end
// before it stops, so that a driver sends the values that others left behind. Those of its outputs end after
// that, so that their readers get nothing between the forced and the safe value.
void Engine::stop_part(std::uint32_t i) noexcept TAPPET_REALTIME {
    EnginePart& part = plan_.parts[i];
    const ComponentState state = part.state.load(std::memory_order_relaxed);
    end_forces(part, FacetKind::input);
    if (state == ComponentState::failed) begin_life(part);
    if (state == ComponentState::stopped || state == ComponentState::failed) {
        end_forces(part, FacetKind::output);
        close_outputs(part, state == ComponentState::failed ? Stops::of_a_life : Stops::of_one_that_stood);
        return;
    }
    part.state.store(ComponentState::stopping, std::memory_order_release);
    begin_life(part);
    commands_.fail(i);
    open_outputs(part); // it may never have started
    if (part.type->stop != nullptr) part.type->stop(part.component_, cycle_);
    if (part.type->stopped_safely != nullptr)
        part.left_unsafe.store(!part.type->stopped_safely(part.component_), std::memory_order_relaxed);
    say_at_rest(part);
    end_forces(part, FacetKind::output);
    close_outputs(part, Stops::of_a_life); // its safe values stay
    cancel_timers(i);
    part.state.store(ComponentState::stopped, std::memory_order_release);
}

void Engine::start_behaviours(std::uint32_t part) noexcept TAPPET_REALTIME {
    for (const Behaviour& each : plan_.behaviours)
        if (each.part == part && is_running(plan_.parts[part].state)) each.start(each.self, cycle_.now);
}

LifeAnswer Engine::check_inputs(std::uint32_t part, Rule rule) noexcept TAPPET_REALTIME {
    for (const NeededInput& each : plan_.inputs) {
        if (each.part != part || (rule == Rule::with_the_machine && !each.valid_to_start)) continue;
        if (const LifeRefusal refusal = refusal_by(each); refusal != LifeRefusal::none)
            return {LifeOutcome::refused, refusal, static_cast<std::uint8_t>(part), each.facet};
    }
    return {LifeOutcome::done, LifeRefusal::none, static_cast<std::uint8_t>(part), 0};
}

bool Engine::may_wait(std::uint32_t part) const noexcept TAPPET_REALTIME {
    for (const NeededInput& each : plan_.inputs)
        if (each.part == part && each.valid_to_start) return true;
    return false;
}

// Its own components have not written yet, so only values from other activities can be judged.
LifeAnswer Engine::readiness(Time now) noexcept TAPPET_REALTIME {
    expect_standing();
    cycle_.now = now; // the ages of values are relative to it
    for (const NeededInput& each : plan_.inputs) {
        if (each.same_activity) continue;
        if (const LifeRefusal refusal = refusal_by(each); refusal != LifeRefusal::none)
            return {LifeOutcome::refused, refusal, static_cast<std::uint8_t>(each.part), each.facet};
    }
    return {.outcome = LifeOutcome::done};
}

LifeTicket Engine::ask(std::uint32_t part, LifeChange wanted) noexcept TAPPET_REALTIME {
    const LifeTicket ticket = plan_.parts[part].requests.ask(wanted);
    asked_.store(true, std::memory_order_release);
    // A periodic real-time activity is not disturbed between its periods.
    if (!plan_.periodic || !plan_.real_time) waiter_.wake();
    return ticket;
}

LifeAnswer Engine::answer_to(std::uint32_t part, LifeTicket ticket) const noexcept TAPPET_REALTIME {
    const LifeAnswer answer = plan_.parts[part].requests.answer_to(ticket);
    if (answer.outcome != LifeOutcome::pending || is_active()) return answer;
    return {LifeOutcome::refused, LifeRefusal::activity_stopped, static_cast<std::uint8_t>(part), 0};
}

void Engine::serve_requests() noexcept TAPPET_REALTIME {
    if (!asked_.exchange(false, std::memory_order_acquire)) return;
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        LifeTicket ticket;
        LifeChange wanted{};
        if (!plan_.parts[i].requests.take(ticket, wanted)) continue;
        if (!is_active()) { // they came while the activity was stopped
            plan_.parts[i].requests.answer(ticket, {LifeOutcome::refused, LifeRefusal::activity_stopped,
                                                    static_cast<std::uint8_t>(i), 0});
            continue;
        }
        EnginePart& part = plan_.parts[i];
        if (part.ends_at != never) { // the last request counts, but its behaviours are already ending
            part.ending = ticket;
            part.wanted = wanted == LifeChange::start ? LifeChange::restart : wanted;
            continue;
        }
        if (wanted != LifeChange::start) stop_behaviours(i);
        if (wanted == LifeChange::start || have_ended(i)) {
            carry_out(i, ticket, wanted);
            continue;
        }
        part.ends_at = cycle_.now + end_limit;
        part.ending = ticket;
        part.wanted = wanted;
        ++ending_;
    }
}

void Engine::carry_out(std::uint32_t i, LifeTicket ticket, LifeChange wanted) noexcept TAPPET_REALTIME {
    LifeAnswer answer;
    timed(i, FunctionKind::reactions, [&]() noexcept TAPPET_REALTIME { answer = change(i, wanted); });
    note(life_note << 32 | std::uint64_t{i} << 8 | static_cast<std::uint64_t>(wanted), cycle_.now);
    plan_.parts[i].requests.answer(ticket, answer);
}

// The whole activity stops now, so the pending request of this component is refused.
void Engine::refuse_ending(std::uint32_t i) noexcept TAPPET_REALTIME {
    EnginePart& part = plan_.parts[i];
    if (part.ends_at == never) return;
    part.ends_at = never;
    --ending_;
    part.requests.answer(
        part.ending, {LifeOutcome::refused, LifeRefusal::activity_stopped, static_cast<std::uint8_t>(i), 0});
}

void Engine::end_parts() noexcept TAPPET_REALTIME {
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        EnginePart& part = plan_.parts[i];
        if (part.ends_at == never || (cycle_.now < part.ends_at && !have_ended(i))) continue;
        part.ends_at = never;
        --ending_;
        carry_out(i, part.ending, part.wanted);
    }
}

LifeAnswer Engine::change(std::uint32_t i, LifeChange wanted) noexcept TAPPET_REALTIME {
    EnginePart& part = plan_.parts[i];
    const ComponentState state = part.state.load(std::memory_order_relaxed);
    const LifeAnswer done{LifeOutcome::done, LifeRefusal::none, static_cast<std::uint8_t>(i), 0};
    if (state == ComponentState::failed)
        return {LifeOutcome::refused, LifeRefusal::not_initialised, static_cast<std::uint8_t>(i), 0};
    if (wanted != LifeChange::start) {
        if (state == ComponentState::waiting) --awaiting_;
        stop_part(i);
    }
    if (wanted == LifeChange::stop && part.left_unsafe.load(std::memory_order_relaxed))
        return {LifeOutcome::refused, LifeRefusal::left_unsafe, static_cast<std::uint8_t>(i), 0};
    if (wanted == LifeChange::stop || is_running(part.state)) return done;
    if (rests(i))
        return {LifeOutcome::refused, LifeRefusal::waits_for_its_turn, static_cast<std::uint8_t>(i), 0};
    if (const LifeAnswer inputs = check_inputs(i, Rule::alone); inputs.refusal != LifeRefusal::none)
        return inputs;
    if (part.state.load(std::memory_order_relaxed) == ComponentState::waiting) --awaiting_;
    start_part(i);
    start_behaviours(i);
    return done;
}

LifeAnswer Engine::enter(Parts entering) noexcept TAPPET_REALTIME {
    resting_ &= ~entering;
    tell_resting();
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        if ((entering >> i & 1) == 0) continue;
        const LifeAnswer answer = change(i, LifeChange::start);
        if (answer.outcome == LifeOutcome::refused) {
            leave(entering);
            return answer;
        }
        note(life_note << 32 | std::uint64_t{i} << 8 | static_cast<std::uint64_t>(LifeChange::start),
             cycle_.now);
    }
    return {.outcome = LifeOutcome::done};
}

LifeAnswer Engine::begin_anew(Parts running) noexcept TAPPET_REALTIME {
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        const EnginePart& part = plan_.parts[i];
        if ((running >> i & 1) == 0 || !is_running(part.state)) continue;
        if (const LifeAnswer inputs = check_inputs(i, Rule::alone); inputs.refusal != LifeRefusal::none)
            return inputs;
        if (part.type->start != nullptr) part.type->start(part.component_, cycle_);
    }
    return {.outcome = LifeOutcome::done};
}

void Engine::leave(Parts leaving) noexcept TAPPET_REALTIME {
    resting_ |= leaving;
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        if ((leaving >> i & 1) == 0) continue;
        static_cast<void>(change(i, LifeChange::stop)); // refused: failed before, or stopped but left_unsafe
        note(life_note << 32 | std::uint64_t{i} << 8 | static_cast<std::uint64_t>(LifeChange::stop),
             cycle_.now);
    }
    tell_resting();
}

void Engine::start_awaiting() noexcept TAPPET_REALTIME {
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        if (plan_.parts[i].state.load(std::memory_order_relaxed) != ComponentState::waiting ||
            check_inputs(i, Rule::with_the_machine).refusal != LifeRefusal::none)
            continue;
        --awaiting_;
        timed(i, FunctionKind::reactions, [&]() noexcept TAPPET_REALTIME { start_part(i); });
        start_behaviours(i);
    }
}

void Engine::mark_failed() noexcept TAPPET_REALTIME {
    for (EnginePart& part : plan_.parts) part.state.store(ComponentState::failed, std::memory_order_release);
}

std::size_t Engine::left_unsafe() const noexcept TAPPET_REALTIME {
    std::size_t i = 0;
    while (i < plan_.parts.size() && !plan_.parts[i].left_unsafe.load(std::memory_order_relaxed)) ++i;
    return i;
}

void Engine::heed_devices_of_running() noexcept TAPPET_REALTIME {
    std::uint32_t at = 0;
    for (const EnginePart& part : plan_.parts) {
        if (part.type->device_kind != nullptr && !part.type->shares_device)
            waiter_.serve(at, is_running(part.state));
        ++at;
    }
}

} // namespace tappet

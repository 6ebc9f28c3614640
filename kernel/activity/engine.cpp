// One cycle of an engine: timers, components, commands, messages, behaviours, and the account of their time.
#include "kernel/activity/engine.hpp"

#include "kernel/component/subscription.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace tappet {

namespace {

/// work() may block: it is called only in activities that are not real-time, which the table's check
/// guarantees.
void work(const ComponentType& type, void* component, const Cycle& cycle) noexcept TAPPET_REALTIME {
    TAPPET_ESCAPE("this activity is not real-time", type.work(component, cycle));
}

} // namespace

void Engine::place(const EnginePlan& plan, os::Clock& clock) noexcept {
    expect_standing();
    plan_ = plan;
    clock_ = &clock;
    stamps_.place(clock);
    cycle_.period = plan.period;
    has_deadline_ = plan.real_time && plan.deadline > Duration::zero();
    least_excess_ = has_deadline_ ? Duration::zero() : Duration::max();
    watches_wakes_ = !plan.periodic && plan.at_most_per > Duration::zero();
    const bool is_simple =
        plan.timers.empty() && plan.guarded.empty() && recorded_ == nullptr && recorder_ == nullptr;
    // An activity that rows wake also records their times.
    const bool only_steps = plan.behaviours.empty() && plan.periodic && !plan.hears_causes;
    serves_ = !is_simple ? Serves::everything : only_steps ? Serves::steps : Serves::behaviours;
    for (EnginePart& part : plan_.parts) {
        part.step = part.type->step;
        close_outputs(part, Stops::of_one_that_stood);
    }
    for (const EngineTimer& each : plan_.timers) each.timer->serve();
}

Time Engine::earliest_wake() const noexcept TAPPET_REALTIME {
    Time next = next_release_;
    for (const EngineTimer& each : plan_.timers) next = std::min(next, due_at(each));
    for (const Behaviour& each : plan_.behaviours)
        if (is_running(plan_.parts[each.part].state)) next = std::min(next, each.next(each.self));
    for (const GuardedInput& each : plan_.guarded) next = std::min(next, each.expires);
    if (awaiting_ != 0) next = std::min(next, cycle_.now + awaiting_period);
    if (ending_ != 0)
        for (const EnginePart& part : plan_.parts) next = std::min(next, part.ends_at);
    return next;
}

[[gnu::always_inline]] inline void Engine::run_components() noexcept TAPPET_REALTIME {
    FunctionTiming* timing = plan_.functions.data();
    for (const EnginePart& part : plan_.parts) {
        FunctionTiming& step = *timing;
        timing += functions_per_part;
        if (!is_running(part.state)) continue;
        if (part.step != nullptr)
            part.step(part.component_, cycle_);
        else if (part.type->work != nullptr)
            work(*part.type, part.component_, cycle_);
        else
            continue;
        account(step, 1);
    }
}
static_assert(FunctionKind::step == FunctionKind{}, "the first of a part's functions");

[[gnu::always_inline]] inline void Engine::end_period() noexcept TAPPET_REALTIME {
    next_release_ += plan_.period;
    if (next_release_ > lap_) return;
    // Whole periods were lost: they are counted, not made up for.
    const auto lost = (lap_ - next_release_) / plan_.period + 1;
    statistics_.skipped_periods += static_cast<std::uint64_t>(lost);
    next_release_ += lost * plan_.period;
}

// A sporadic activity promises at most n wakes in a window. The analysis relies on it: breaches are counted.
[[gnu::always_inline]] inline void Engine::watch_wakes() noexcept TAPPET_REALTIME {
    const auto n = static_cast<std::uint64_t>(plan_.at_most_n);
    Time& oldest = wakes_[oldest_wake_];
    if (wake_count_ >= n && cycle_.now - oldest < plan_.at_most_per) {
        ++statistics_.wakes_too_many;
        measure_processor();
    }
    oldest = cycle_.now;
    oldest_wake_ = oldest_wake_ + 1 == n ? 0 : oldest_wake_ + 1;
    ++wake_count_;
}

template <Engine::Serves serves>
void Engine::cycle_as(bool woken) noexcept TAPPET_REALTIME {
    constexpr bool everything = serves == Serves::everything, causes = serves != Serves::steps;
    // A new stamp, not the end of the cycle before when the thread ran straight on: after a preemption in
    // between, the cycle would count as late.
    const Time now = stamps_.now();
    cycle_.now = lap_ = now;
    Duration used{};
    bool measures = false;
    auto expired = Expired::none;
    if constexpr (everything) {
        if (measures_processor_) measures = measures_cycle();
        if (measures) used = used_processor();
        if (!plan_.periodic) expired = look_at_expired();
    }
    const bool due = plan_.periodic ? now >= next_release_ : woken || expired == Expired::stale;
    Time release = due && plan_.periodic ? next_release_ : now;
    if constexpr (everything)
        for (const EngineTimer& each : plan_.timers) release = std::min(release, due_at(each));
    const std::uint64_t generation = begin_change();
    WakingRow* waking = nullptr;
    if constexpr (causes) {
        waking = due && !plan_.periodic ? take_waking_row() : nullptr;
        cause_ = waking == nullptr ? no_cause : waking->cause();
        // A period serves its messages behind its components, so these act on them in the next one.
        if (due && plan_.periodic) cause_ = std::exchange(left_, no_cause);
        set_running_cause(cause_);
    }
    cycle_.release = release;
    worst_excess_ = least_excess_;
    if constexpr (everything) {
        tape_ = recorded_ != nullptr && recorded_->is_on() ? recorded_ : nullptr;
        if (tape_ != nullptr) tape_->begin();
    }
    if (watches_wakes_ && (due || expired == Expired::none)) // polling an input that is still good is no wake
        watch_wakes();
    if (ends_at_ == never) { // a request to start during the end is refused when the activity has stopped
        if (asked_.load(std::memory_order_relaxed)) serve_requests(); // no step: a hint, taken by an exchange
        if (awaiting_ != 0) start_awaiting();
    }
    bool acted = false;
    if constexpr (everything) acted = run_timers();
    if (due) run_components();
    if constexpr (causes)
        if (plan_.periodic) cause_ = running_cause(); // or that of a value which an input brought
    if (commands_.has_work()) acted |= run_commands();
    if (inbox_.pending()) acted |= run_messages();
    if constexpr (causes) {
        set_running_cause(cause_);
        run_behaviours(due || acted); // these functions may have changed a condition
        if (ending_ != 0) end_parts();
        if (waking != nullptr) waking->times.add(lap_ - cause_);
        set_running_cause(no_cause);
    }
    if constexpr (everything) {
        watch_inputs();
        if (recorder_ != nullptr) record_values(due);
        if (measures) note_processor(used);
    }
    ++statistics_.cycles;
    const Duration response = lap_ - cycle_.release;
    if (response > (cycle_.release == now ? quiet_busy_ : quiet_response_)) note_response(response);
    if (due && plan_.periodic) end_period();
    if constexpr (everything)
        if (tape_ != nullptr) tape_->end(to_ns(cycle_.release), to_ns(cycle_.now), to_ns(lap_));
    end_change(generation);
}
template void Engine::cycle_as<Engine::Serves::steps>(bool) noexcept TAPPET_REALTIME;
template void Engine::cycle_as<Engine::Serves::behaviours>(bool) noexcept TAPPET_REALTIME;
template void Engine::cycle_as<Engine::Serves::everything>(bool) noexcept TAPPET_REALTIME;

// Between the two steps a newer value may name its own row. That sample is lost, but no time is wrong.
WakingRow* Engine::take_waking_row() noexcept TAPPET_REALTIME {
    WakingRow* const row = waking_.load(std::memory_order_acquire);        // no step: for the report
    if (row != nullptr) waking_.store(nullptr, std::memory_order_relaxed); // no step: for the report
    return row;
}

bool Engine::run_timers() noexcept TAPPET_REALTIME {
    bool acted = false;
    for (const EngineTimer& each : plan_.timers) {
        const Time when = due_at(each);
        if (when > cycle_.now) continue;
        each.timer->cancel();
        Cycle at = cycle_;
        at.release = when;
        note(each.part, when);
        timed(each.part, FunctionKind::timers,
              [&]() noexcept TAPPET_REALTIME { each.fire(plan_.parts[each.part].component_, at); });
        acted = true;
    }
    return acted;
}

bool Engine::run_commands() noexcept TAPPET_REALTIME {
    const auto note_state = [this](std::uint32_t part, CommandState state) noexcept
        TAPPET_REALTIME { note((std::uint64_t{part} << 8) | static_cast<std::uint64_t>(state), cycle_.now); };
    // Consecutive commands of one component are timed together.
    constexpr std::uint32_t nobody = Miss::nobody;
    std::uint32_t at_work = nobody;
    std::uint64_t together = 0;
    const auto turn_to = [&](std::uint32_t part) noexcept TAPPET_REALTIME {
        if (at_work != part && at_work != nobody) {
            end_of(function(at_work, FunctionKind::reactions), together);
            together = 0;
        }
        at_work = part;
        ++together;
    };
    std::size_t served = 0;
    if (commands_.pending())
        served = commands_.serve([&](std::uint32_t part, CommandSlot& slot) noexcept TAPPET_REALTIME {
            turn_to(part);
            note_state(part, commands_.take_up(slot));
        });
    const bool ended = commands_.follow([&](std::uint32_t part, CommandSlot& slot) noexcept TAPPET_REALTIME {
        if (slot.has_completion()) turn_to(part); // otherwise none of its code runs any more
        const CommandState state = slot.follow();
        if (!in_flight(state)) note_state(part, state);
        return !in_flight(state);
    });
    turn_to(nobody);
    return served != 0 || ended;
}

void Engine::note(const Message& message) noexcept TAPPET_REALTIME {
    note(message.id, cycle_.now);
    const std::span<const std::byte> arguments = AsyncReaction::arguments_of(message);
    for (std::size_t at = 0; at < arguments.size(); at += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, arguments.data() + at, sizeof word);
        digest_.add(word);
    }
}

bool Engine::run_messages() noexcept TAPPET_REALTIME {
    const std::size_t served = inbox_.serve([this](const Message& message) noexcept TAPPET_REALTIME {
        if (clock_->is_virtual()) note(message);
        set_running_cause(message.cause);
        timed(message.id, FunctionKind::reactions,
              [&]() noexcept TAPPET_REALTIME { message.run(message.object, message.arguments.data()); });
        if (message.cause == no_cause) return;
        AsyncReaction::note_end(message, lap_);
        if (cause_ == no_cause) cause_ = message.cause;
        if (left_ == no_cause) left_ = message.cause;
    });
    set_running_cause(no_cause);
    statistics_.messages += served;
    return served != 0;
}

void Engine::run_behaviours(bool all) noexcept TAPPET_REALTIME {
    for (const Behaviour& each : plan_.behaviours) {
        if (each.programs == nullptr || !is_running(plan_.parts[each.part].state)) continue;
        if (!all && each.next(each.self) > cycle_.now) continue;
        if (each.programs(each.self, cycle_.now)) end_of(function(each.part, FunctionKind::behaviour));
    }
    for (const Behaviour& each : plan_.behaviours) {
        if (!is_running(plan_.parts[each.part].state)) continue;
        if (!all && each.next(each.self) > cycle_.now) continue;
        if (each.step(each.self, cycle_.now)) end_of(function(each.part, FunctionKind::behaviour));
    }
}

Engine::Expired Engine::look_at_expired() noexcept TAPPET_REALTIME {
    auto found = Expired::none;
    for (GuardedInput& each : plan_.guarded) {
        if (each.expires > cycle_.now) continue;
        // A newer value may have come from a row that wakes nobody.
        const bool stale = each.port->flow(each.input) == Flow::stale;
        each.expires = stale ? never : each.port->expires(each.input);
        if (stale || found == Expired::none) found = stale ? Expired::stale : Expired::looked;
    }
    return found;
}

void Engine::watch_inputs() noexcept TAPPET_REALTIME {
    for (GuardedInput& each : plan_.guarded) {
        each.expires = never;
        if (!is_running(plan_.parts[each.part].state)) {
            each.was_valid = false;
            continue;
        }
        const Flow flow = each.port->flow(each.input);
        if (flow == Flow::stale && each.was_valid && each.stops)
            ask_stop(StopReason::stale_input, each.connection);
        each.was_valid = flow == Flow::fresh || flow == Flow::old;
        if (flow != Flow::stale && !plan_.periodic) each.expires = each.port->expires(each.input);
    }
}

void Engine::record_values(bool stepped) noexcept TAPPET_REALTIME {
    recorder_->record(*recorder_, cycle_, stepped);
    lap_ = stamps_.now();
}

// Virtual time has no preemption, and its processor is that of any host.
Duration Engine::used_processor() const noexcept TAPPET_REALTIME {
    return clock_->is_virtual() ? clock_->now() - Time{} : os::processor_time_of_this_thread();
}

bool Engine::measures_cycle() noexcept TAPPET_REALTIME {
    // As the analysis counts: wakes that come together are one job; the next one comes a time of at_most
    // later.
    if (!plan_.periodic && claim_began_ != Time::min() && cycle_.now - claim_began_ < plan_.at_most_per)
        return measures_claim_;
    claim_began_ = cycle_.now;
    claim_used_ = {};
    measures_claim_ = next_measured_ != 0 || left_out_ == 0;
    if (!measures_claim_) {
        --left_out_;
        return false;
    }
    if (next_measured_ != 0) --next_measured_;
    // At random: jobs at regular times would be measured always or never.
    left_out_ = static_cast<std::uint32_t>(chance_.below(2 * measured_one_of - 1));
    ++statistics_.measured_claims;
    return true;
}

void Engine::note_processor(Duration before) noexcept TAPPET_REALTIME {
    const Duration used_before = claim_used_;
    claim_used_ += used_processor() - before;
    statistics_.most_processor = std::max(statistics_.most_processor, claim_used_);
    if (claim_used_ <= plan_.claim() || used_before > plan_.claim()) return;
    claim_exceeded_by_ = claim_used_ - plan_.claim();
    ++statistics_.over_claim;
}

void Engine::note_excess(const FunctionTiming& function, Duration took) noexcept TAPPET_REALTIME {
    worst_usual_ = function.usual();
    worst_excess_ = took - worst_usual_;
    worst_function_ = index_of(function);
    worst_took_ = took;
}

void Engine::note_miss(Duration response) noexcept TAPPET_REALTIME {
    const Duration lateness = cycle_.now - cycle_.release;
    Miss miss{worst_function_, cycle_.release, response, worst_took_, worst_usual_};
    // If the cycle began later than any function exceeded its usual time, the delay is to blame, no function.
    if (worst_excess_ == least_excess_ || lateness > worst_excess_)
        miss = {Miss::nobody, cycle_.release, response, lateness, Duration::zero()};
    else
        ++plan_.functions[worst_function_].blamed;
    statistics_.recent_misses[statistics_.misses % statistics_.recent_misses.size()] = miss;
    ++statistics_.misses;
    if (plan_.stop_when_late) ask_stop(StopReason::missed_deadline, miss.function);
}

// Reading the thread's processor time enters the kernel. If never busy for longer than its budget, and never
// woken too often, the activity kept its claim, whatever else ran. Otherwise it may have been preempted, or
// have claimed too little.
void Engine::measure_processor() noexcept TAPPET_REALTIME {
    if (measures_processor_ || plan_.budget <= Duration::zero()) return;
    measures_processor_ = true;
    serves_ = Serves::everything;
}

// A response that exceeds neither the longest lateness nor the longest busy time is no new maximum of either,
// which are parts of it, nor of their sum.
void Engine::note_response(Duration response) noexcept TAPPET_REALTIME {
    EngineStatistics& seen = statistics_;
    if (seen.cycles > 1) { // the first cycle warms caches: it runs, but counts for no maximum
        seen.longest_response = std::max(seen.longest_response, response);
        seen.longest_lateness = std::max(seen.longest_lateness, cycle_.now - cycle_.release);
        seen.longest_busy = std::max(seen.longest_busy, lap_ - cycle_.now);
        if (seen.longest_busy > plan_.budget) measure_processor();
        quiet_busy_ = has_deadline_ ? std::min(seen.longest_busy, plan_.deadline) : seen.longest_busy;
        quiet_response_ = std::min(seen.longest_lateness, quiet_busy_);
    }
    if (has_deadline_ && response > plan_.deadline) note_miss(response);
}

} // namespace tappet

// One cycle of an engine: timers, components, commands, messages, behaviours, and the account of their time.
#include "kernel/activity/engine.hpp"

#include <algorithm>
#include <cstring>

namespace tappet {

namespace {

/// work() may block: it is called only in activities that are not real-time, which the table's check
/// guarantees.
void work(const EnginePart& part, const Cycle& cycle) noexcept TAPPET_REALTIME {
    TAPPET_ESCAPE("this activity is not real-time", part.type->work(part.component, cycle));
}

} // namespace

Time Engine::next_wake() const noexcept TAPPET_REALTIME {
    Time next = next_release_;
    for (const EngineTimer& each : plan_.timers) next = std::min(next, due_at(each));
    for (const Behaviour& each : plan_.behaviours)
        if (is_running(plan_.parts[each.part].state)) next = std::min(next, each.next(each.self));
    if (awaiting_ != 0) next = std::min(next, cycle_.now + awaiting_period);
    return next;
}

bool Engine::begin_change() noexcept TAPPET_REALTIME {
    if (generation() % 2 != 0) return false;
    generation_.fetch_add(1, std::memory_order_acq_rel); // observe.begin
    return true;
}

void Engine::end_change(bool begun) noexcept TAPPET_REALTIME {
    if (begun) generation_.fetch_add(1, std::memory_order_release); // observe.end
}

void Engine::run(bool woken) noexcept TAPPET_REALTIME {
    const RunsActivity here{plan_.activity};
    const Time now = clock_->now();
    Time release = now;
    const bool due = plan_.periodic ? now >= next_release_ : woken;
    if (due && plan_.periodic) release = next_release_;
    for (const EngineTimer& each : plan_.timers) release = std::min(release, due_at(each));
    const bool begun = begin_change();
    cycle_.now = lap_ = now;
    cycle_.release = release;
    worst_excess_ = Duration::zero();
    worst_function_ = Miss::nobody;
    tape_ = recorded_ != nullptr && recorded_->is_on() ? recorded_ : nullptr;
    if (tape_ != nullptr) tape_->begin();
    watch_wakes();
    if (asked_.load(std::memory_order_relaxed)) serve_requests(); // no step: a hint, taken by an exchange
    if (awaiting_ != 0) start_awaiting();
    bool acted = run_timers();
    if (due) run_components();
    acted |= run_commands();
    acted |= run_messages();
    run_behaviours(due || acted); // what ran may have changed a condition
    watch_inputs();
    account();
    if (tape_ != nullptr) tape_->end(to_ns(cycle_.release), to_ns(cycle_.now), to_ns(lap_));
    end_change(begun);
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
              [&]() noexcept TAPPET_REALTIME { each.fire(plan_.parts[each.part].component, at); });
        acted = true;
    }
    return acted;
}

void Engine::run_components() noexcept TAPPET_REALTIME {
    for (std::uint32_t i = 0; i < plan_.parts.size(); ++i) {
        const EnginePart& part = plan_.parts[i];
        if (!is_running(part.state)) continue;
        if (part.type->step != nullptr)
            timed(i, FunctionKind::step,
                  [&]() noexcept TAPPET_REALTIME { part.type->step(part.component, cycle_); });
        else if (part.type->work != nullptr)
            timed(i, FunctionKind::step, [&]() noexcept TAPPET_REALTIME { work(part, cycle_); });
    }
}

bool Engine::run_commands() noexcept TAPPET_REALTIME {
    const auto note_state = [this](std::uint32_t part, CommandState state) noexcept
        TAPPET_REALTIME { note((std::uint64_t{part} << 8) | static_cast<std::uint64_t>(state), cycle_.now); };
    std::size_t served = 0;
    if (commands_.pending())
        served = commands_.serve([&](std::uint32_t part, CommandSlot& slot) noexcept TAPPET_REALTIME {
            timed(part, FunctionKind::reactions, [&]() noexcept TAPPET_REALTIME {
                note_state(part, commands_.take_up(slot, is_running(plan_.parts[part].state)));
            });
        });
    const bool ended = commands_.follow([&](std::uint32_t part, CommandSlot& slot) noexcept TAPPET_REALTIME {
        CommandState state{};
        timed(part, FunctionKind::reactions, [&]() noexcept TAPPET_REALTIME { state = slot.follow(); });
        if (!in_flight(state)) note_state(part, state);
        return !in_flight(state);
    });
    return served != 0 || ended;
}

bool Engine::run_messages() noexcept TAPPET_REALTIME {
    if (!inbox_.pending()) return false;
    const std::size_t served = inbox_.serve([this](const Message& message) noexcept TAPPET_REALTIME {
        note(message.id, cycle_.now);
        for (std::size_t at = 0; at < message.arguments.size(); at += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, message.arguments.data() + at, sizeof word);
            digest_.add(word);
        }
        timed(message.id, FunctionKind::reactions,
              [&]() noexcept TAPPET_REALTIME { message.run(message.object, message.arguments.data()); });
    });
    statistics_.messages += served;
    return served != 0;
}

void Engine::run_behaviours(bool all) noexcept TAPPET_REALTIME {
    for (const Behaviour& each : plan_.behaviours) {
        if (each.programs == nullptr || !is_running(plan_.parts[each.part].state)) continue;
        if (!all && each.next(each.self) > cycle_.now) continue;
        timed(each.part, FunctionKind::behaviour,
              [&]() noexcept TAPPET_REALTIME { each.programs(each.self, cycle_.now); });
    }
    for (const Behaviour& each : plan_.behaviours) {
        if (!is_running(plan_.parts[each.part].state)) continue;
        if (!all && each.next(each.self) > cycle_.now) continue;
        timed(each.part, FunctionKind::behaviour,
              [&]() noexcept TAPPET_REALTIME { each.step(each.self, cycle_.now); });
    }
}

void Engine::watch_inputs() noexcept TAPPET_REALTIME {
    for (GuardedInput& each : plan_.guarded) {
        if (!is_running(plan_.parts[each.part].state)) {
            each.was_valid = false;
            continue;
        }
        const Flow flow = each.flow(each.input);
        if (flow == Flow::stale && each.was_valid) ask_stop(StopReason::stale_input, each.connection);
        each.was_valid = flow == Flow::fresh || flow == Flow::old;
    }
}

// Sporadic activities promised at most n wakes in a window: the analysis believed it, so a breach is counted.
void Engine::watch_wakes() noexcept TAPPET_REALTIME {
    if (plan_.periodic || plan_.at_most_per <= Duration::zero()) return;
    const auto n = static_cast<std::uint64_t>(plan_.at_most_n);
    Time& oldest = wakes_[wake_count_ % n];
    if (wake_count_ >= n && cycle_.now - oldest < plan_.at_most_per) ++statistics_.wakes_too_many;
    oldest = cycle_.now;
    ++wake_count_;
}

void Engine::account() noexcept TAPPET_REALTIME {
    const Time end = lap_;
    const Duration response = end - cycle_.release;
    const Duration lateness = cycle_.now - cycle_.release;
    ++statistics_.cycles;
    if (statistics_.cycles > 1) { // the first cycle warms caches: it is run, and counted as no maximum
        statistics_.longest_response = std::max(statistics_.longest_response, response);
        statistics_.longest_lateness = std::max(statistics_.longest_lateness, lateness);
        statistics_.longest_busy = std::max(statistics_.longest_busy, end - cycle_.now);
    }
    if (plan_.real_time && plan_.deadline > Duration::zero() && response > plan_.deadline) {
        Miss miss{worst_function_, cycle_.release, response, worst_took_, worst_usual_};
        // Begun later than any function exceeded its usual time: the delay is the culprit, no function is.
        if (worst_function_ == Miss::nobody || lateness > worst_excess_)
            miss = {Miss::nobody, cycle_.release, response, lateness, Duration::zero()};
        else
            ++plan_.functions[worst_function_].blamed;
        statistics_.recent_misses[statistics_.misses % statistics_.recent_misses.size()] = miss;
        ++statistics_.misses;
        if (plan_.stop_when_late) ask_stop(StopReason::missed_deadline, miss.function);
    }
    if (!plan_.periodic) return;
    if (cycle_.now < next_release_) return;
    next_release_ += plan_.period;
    if (next_release_ <= end) { // whole periods were lost: they are counted, not made up for
        const auto lost = (end - next_release_) / plan_.period + 1;
        statistics_.skipped_periods += static_cast<std::uint64_t>(lost);
        next_release_ += lost * plan_.period;
    }
}

} // namespace tappet

// Runs a slot in its engine: steps the active behaviour, hands over to the new one at its moment, and takes
// that one back when it fails its trial.
#include "kernel/machine/slots/behaviour_slot.hpp"

#include "kernel/activity/engine.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tappet {

namespace {

/// The steps that an old behaviour has to enter and leave its final state; after them it is dropped.
constexpr std::uint32_t hand_over_steps = 1000;
constexpr double full_turn_deg = 360;

} // namespace

void BehaviourSlot::obey(void* slot, const std::byte*) noexcept TAPPET_REALTIME {
    auto& self = *static_cast<BehaviourSlot*>(slot);
    const bool lets_go = self.asked_change_ == Change::roll_back && self.phase() == SlotPhase::waiting;
    self.why_ = RollBack::none;
    self.is_roll_back_ = self.asked_change_ == Change::roll_back;
    self.last_angle_ = -1;
    switch (self.asked_change_) {
    case Change::take_over: self.target_ = self.spare(); break;
    case Change::unload: self.target_ = none; break;
    case Change::roll_back:
        self.target_ = self.previous_.load(std::memory_order_relaxed);
        self.why_ = RollBack::asked;
        ++self.roll_backs_;
        break;
    }
    self.moment_ = self.asked_moment_;
    self.set(!lets_go ? SlotPhase::waiting : self.active() == nullptr ? SlotPhase::empty : SlotPhase::steady);
    if (lets_go) self.connect(self.runs_);
    self.asked_.store(false, std::memory_order_release);
}

/// Whether the moment has come. The angle is passed upwards once a turn: from below to it or beyond it, by
/// less than half a turn in one step. An angle that moves backwards passes nothing.
bool BehaviourSlot::is_due() noexcept TAPPET_REALTIME {
    switch (moment_.kind) {
    case SlotMoment::Kind::now: return true;
    case SlotMoment::Kind::event: return false; // dispatch() sees it
    case SlotMoment::Kind::angle: break;
    }
    // The angle beyond the wanted one, 0 to 360: a value below the last one has completed a turn.
    double beyond = place_.angle->last() - moment_.angle_deg;
    beyond -= full_turn_deg * std::floor(beyond / full_turn_deg);
    const bool passed = last_angle_ - beyond > full_turn_deg / 2;
    last_angle_ = beyond;
    return passed;
}

void BehaviourSlot::connect(bool on) noexcept TAPPET_REALTIME {
    const BehaviourUnit* unit = active();
    for (std::size_t e = 0; e < place_.handles.size(); ++e) {
        const bool awaited =
            phase() == SlotPhase::waiting && moment_.kind == SlotMoment::Kind::event && moment_.event == e;
        const bool wanted = awaited || (on && unit != nullptr && unit->hears(e));
        const EventHandle& handle = place_.handles[e];
        if (wanted && !handle.connected()) handle.connect();
        if (!wanted && handle.connected()) handle.disconnect();
    }
}

void BehaviourSlot::start(Time now) noexcept TAPPET_REALTIME {
    runs_ = true;
    connect(true);
    if (phase() == SlotPhase::handing_over) return; // the active behaviour is ending
    if (BehaviourUnit* unit = active(); unit != nullptr) unit->start(now);
}

void BehaviourSlot::stop(Time now) noexcept TAPPET_REALTIME {
    runs_ = false;
    if (BehaviourUnit* unit = active(); unit != nullptr) unit->finish(now, "its component stops");
    exchange();
}

bool BehaviourSlot::step_programs(Time now) noexcept TAPPET_REALTIME {
    BehaviourUnit* const unit = active();
    const bool worked = unit != nullptr && unit->step_programs(now);
    exchange();
    return worked;
}

bool BehaviourSlot::step(Time now) noexcept TAPPET_REALTIME {
    const SlotPhase before = phase();
    if (before == SlotPhase::waiting) {
        connect(true);
        if (is_due()) hand_over(now);
    } else if (before == SlotPhase::handing_over) {
        hand_over(now);
    }
    BehaviourUnit* unit = active();
    if (unit == nullptr) return before != phase();
    const bool worked = unit->step(now);
    judge(now);
    exchange();
    return worked || before != phase() || before == SlotPhase::handing_over;
}

void BehaviourSlot::hand_over(Time now) noexcept TAPPET_REALTIME {
    BehaviourUnit* old = active();
    if (phase() != SlotPhase::handing_over) {
        set(SlotPhase::handing_over);
        steps_left_ = hand_over_steps;
        if (old != nullptr) old->finish(now, "another behaviour takes over");
    }
    if (old != nullptr && old->is_active() && steps_left_-- != 0) {
        if (!old->is_finished()) return;
        old->deactivate(now);
        if (old->is_active()) return;
    }
    if (old != nullptr) old->drop();
    switch_to_target(now);
}

void BehaviourSlot::switch_to_target(Time now) noexcept TAPPET_REALTIME {
    const int before = active_.load(std::memory_order_relaxed);
    previous_.store(before == target_ ? none : before, std::memory_order_relaxed);
    active_.store(target_, std::memory_order_relaxed);
    ++loads_;
    set(target_ == none ? SlotPhase::empty : is_roll_back_ ? SlotPhase::steady : SlotPhase::trial);
    steps_left_ = place_.row->slot.trial;
    bases_left_ = 2;
    connect(true);
    BehaviourUnit* const unit = active();
    if (unit == nullptr) return;
    // A taken-back behaviour leaves no traces: the old one gets its variables as they were, or as people set
    // them.
    for (SlotTask* task = tasks_; task != nullptr; task = task->next)
        task->exchange(*unit, bank(), is_roll_back_ ? SlotTask::When::take_back : SlotTask::When::take_over);
    if (runs_) unit->start(now);
}

namespace {

/// Timings of the two functions in which a slot's behaviour runs.
struct Timings {
    const FunctionTiming &reactions, &behaviour;
    Timings(const Engine& engine, std::size_t part) noexcept TAPPET_REALTIME
        : reactions{of(engine, part, FunctionKind::reactions)},
          behaviour{of(engine, part, FunctionKind::behaviour)} {}
    static const FunctionTiming& of(const Engine& engine, std::size_t part, FunctionKind kind) noexcept
        TAPPET_REALTIME {
        return engine.plan().functions[part * functions_per_part + static_cast<std::size_t>(kind)];
    }
};

} // namespace

std::uint64_t BehaviourSlot::misses() const noexcept TAPPET_REALTIME {
    const Timings of{*place_.engine, place_.part};
    return of.reactions.blamed + of.behaviour.blamed;
}
Duration BehaviourSlot::time_taken() const noexcept TAPPET_REALTIME {
    const Timings of{*place_.engine, place_.part};
    return of.reactions.total + of.behaviour.total;
}

void BehaviourSlot::judge(Time now) noexcept TAPPET_REALTIME {
    BehaviourUnit& unit = *active();
    if (phase() != SlotPhase::trial) {
        if (phase() == SlotPhase::steady) unit.report_errors();
        return;
    }
    if (unit.failed_part() != nullptr) return take_back(RollBack::error, now);
    if (unit.left_over()) return take_back(RollBack::left_over, now);
    place_.engine->measure_as_at_first();
    const std::uint64_t over_claim = place_.engine->statistics().over_claim;
    const Duration taken_now = time_taken() - std::exchange(taken_before_, time_taken());
    // Reactions of the previous cycle are included in its judgement; the step of its behaviour is seen only
    // now.
    const Duration taken = taken_now + std::exchange(taken_last_, taken_now);
    // The cycle of the hand-over includes the end of the old behaviour: times are judged from the next cycle
    // on.
    if (bases_left_ != 0) {
        --bases_left_;
        misses_before_ = misses();
        over_claim_before_ = over_claim;
        kept_its_claim_ = over_claim == 0;
    } else if (misses() != misses_before_) {
        return take_back(RollBack::late, now);
    } else if (over_claim != std::exchange(over_claim_before_, over_claim) && kept_its_claim_ &&
               taken >= place_.engine->claim_exceeded_by()) {
        // The activity kept its claim until now, and would have kept it without this behaviour.
        return take_back(RollBack::too_much, now);
    }
    // A behaviour that received no request has proved nothing: a stopped loom does not test a weave.
    if (unit.has_worked() && (steps_left_ == 0 || --steps_left_ == 0)) set(SlotPhase::steady);
}

// A failed behaviour is not trusted: its final state is requested, its exit programs get one chance, and it
// is dropped.
void BehaviourSlot::take_back(RollBack why, Time now) noexcept TAPPET_REALTIME {
    BehaviourUnit& failed = *active();
    why_ = why;
    ++roll_backs_;
    failed.note_fault();
    failed.finish(now, "it failed its trial");
    failed.deactivate(now);
    if (failed.is_active()) failed.deactivate(now);
    failed.drop();
    target_ = previous_.load(std::memory_order_relaxed);
    is_roll_back_ = true;
    switch_to_target(now);
    previous_.store(none, std::memory_order_relaxed);
}

Time BehaviourSlot::next() const noexcept TAPPET_REALTIME {
    const BehaviourUnit* unit = active();
    return unit == nullptr ? never : unit->next();
}

void BehaviourSlot::dispatch(std::size_t event, const std::byte* packed, Time now) noexcept TAPPET_REALTIME {
    if (phase() == SlotPhase::waiting && moment_.kind == SlotMoment::Kind::event && moment_.event == event)
        hand_over(now);
    if (BehaviourUnit* unit = active(); unit != nullptr && runs_) unit->dispatch(event, packed, now);
    exchange();
}

} // namespace tappet

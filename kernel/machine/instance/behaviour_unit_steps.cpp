// Steps the machines and programs of a unit of behaviour; its engine calls these functions.
#include "kernel/machine/instance/instance.hpp"
#include "kernel/machine/slots/behaviour_unit.hpp"

#include <algorithm>
#include <new>
#include <utility>

namespace tappet {

bool BehaviourUnit::hears(std::size_t event) const noexcept TAPPET_REALTIME {
    for (std::size_t i = 0; i < parts_.size(); ++i)
        if (routes_[event * parts_.size() + i].trigger != no_trigger) return true;
    return false;
}

bool BehaviourUnit::is_quiet() const noexcept TAPPET_REALTIME {
    for (const UnitPart& part : parts_)
        for (std::size_t i = 0; i < part.slot_count; ++i)
            if (!part.slots[i].is_mine()) return false;
    return true;
}

// The stop of a component leaves its machines in the final state; the next start continues from there.
void BehaviourUnit::start(Time now) noexcept TAPPET_REALTIME {
    reported_ = false;
    may_begin_ = true;
    for (UnitPart& part : parts_) {
        if (part.row->parent != no_instance) continue;
        if (part.program != nullptr) {
            // A command that a final state sent last, and whose end it did not see, is over.
            static_cast<void>(part.row->on_command ? part.program->stop() : part.program->start());
            continue;
        }
        if (part.machine->is_active())
            begin_anew(part, now);
        else if (options_.reactive)
            static_cast<void>(part.machine->activate(now));
        else
            static_cast<void>(part.machine->start(now));
    }
    judge_gates();
}

void BehaviourUnit::judge_gates() noexcept TAPPET_REALTIME {
    for (StateGate* each = gates_; each != nullptr; each = each->next) {
        bool open = false;
        for (const StateGate::Where& where : each->open_in)
            open |= !parts_[where.instance].machine->in_error() &&
                    parts_[where.instance].machine->is_in(where.state);
        if (each->gate.set_open(open)) each->driver();
    }
}

// A machine in error stays as it is, for the report.
void BehaviourUnit::begin_anew(UnitPart& part, Time now) noexcept TAPPET_REALTIME {
    part.begins_anew =
        part.machine->request_initial(now) == StateOutcome::ignored && !part.machine->in_error();
}

void BehaviourUnit::limit_work(Time now) noexcept TAPPET_REALTIME {
    const Duration deadline = engine_->plan().deadline;
    limit_.until = deadline > Duration::zero() ? now + deadline : never;
    has_worked_ |= std::exchange(limit_.has_begun, false);
}

bool BehaviourUnit::has_worked() noexcept TAPPET_REALTIME {
    has_worked_ |= std::exchange(limit_.has_begun, false);
    return std::exchange(has_worked_, false);
}

bool BehaviourUnit::step_programs(Time now) noexcept TAPPET_REALTIME {
    if (!has_programs_) return false;
    limit_work(now);
    for (UnitPart& part : parts_) {
        if (part.program == nullptr) continue;
        const bool ran = part.program->status() == ProgramStatus::running;
        part.program->step(now);
        if (ran && is_at_rest(part)) await_rest(part); // the sender of its command polls
    }
    limit_.until = never;
    return true;
}

bool BehaviourUnit::step(Time now) noexcept TAPPET_REALTIME {
    bool worked = false, failed = false, left_over = false;
    limit_work(now);
    stepped_at_ = now;
    for (UnitPart& part : parts_) {
        if (part.awaited != 0 && is_at_rest(part)) [[unlikely]]
            --part.awaited;
        if (part.machine != nullptr) {
            worked |= part.machine->step(now);
            if (part.begins_anew) [[unlikely]] {
                begin_anew(part, now);
                worked = true;
            }
        }
        left_over |= part.left_over();
        failed |= part.has_failed();
    }
    limit_.until = never; // what makes the component safe is not cut short
    has_failed_ = failed;
    judge_gates();
    if (worked && left_over) ++left_over_;
    return worked;
}

void BehaviourUnit::finish(Time now, std::string_view reason) noexcept TAPPET_REALTIME {
    may_begin_ = false;
    for (UnitPart& part : parts_) {
        part.begins_anew = false;
        if (part.program != nullptr)
            static_cast<void>(part.program->stop());
        else
            static_cast<void>(part.machine->request_final(now, reason));
    }
    judge_gates();
}

bool BehaviourUnit::is_finished() const noexcept TAPPET_REALTIME {
    for (const UnitPart& part : parts_)
        if (part.machine != nullptr && part.machine->is_active() && !part.machine->in_error() &&
            (!part.machine->is_final() || part.machine->under_way()))
            return false;
    return true;
}

void BehaviourUnit::deactivate(Time now) noexcept TAPPET_REALTIME {
    for (UnitPart& part : parts_)
        if (part.machine != nullptr) static_cast<void>(part.machine->deactivate(now));
    judge_gates();
}

bool BehaviourUnit::component_runs() const noexcept TAPPET_REALTIME {
    return machine_->gate_of(driven_)->admits(Entry::queued);
}

bool BehaviourUnit::is_active() const noexcept TAPPET_REALTIME {
    for (const UnitPart& part : parts_)
        if (part.machine != nullptr ? part.machine->is_active() : part.program->is_at_work()) return true;
    return false;
}

void BehaviourUnit::drop() noexcept TAPPET_REALTIME {
    for (UnitPart& part : parts_) {
        if (part.program != nullptr) {
            static_cast<void>(part.program->stop());
            continue;
        }
        new (part.machine) StateMachineExecution{};
        static_cast<void>(part.machine->bind(part.binding));
        part.machine->trace(trace_, trace_context_);
    }
    judge_gates();
}

const UnitPart* BehaviourUnit::failed_part() const noexcept TAPPET_REALTIME {
    for (const UnitPart& part : parts_)
        if (part.has_failed()) return &part;
    return nullptr;
}

bool BehaviourUnit::left_over() const noexcept TAPPET_REALTIME {
    for (const UnitPart& part : parts_)
        if (part.left_over()) return true;
    return false;
}

void BehaviourUnit::note_fault() noexcept TAPPET_REALTIME {
    const UnitPart* part = failed_part();
    if (part == nullptr) return;
    fault_.instance = static_cast<InstanceIndex>(part - parts_.data());
    if (part->program != nullptr)
        fault_.line = part->program->line();
    else
        fault_.machine = part->machine->fault();
}

void BehaviourUnit::report_failure() noexcept TAPPET_REALTIME {
    const UnitPart* part = failed_part();
    if (part == nullptr) return;
    reported_ = true;
    note_fault();
    if (options_.on_error == OnError::stop_machine && part->row->parent == no_instance)
        machine_->ask_stop(StopReason::behaviour, driven_, engine_);
}

Time BehaviourUnit::next() const noexcept TAPPET_REALTIME {
    Time earliest = never;
    for (const UnitPart& part : parts_)
        earliest = std::min(earliest, part.awaited != 0 && is_at_rest(part) ? stepped_at_
                                      : part.machine != nullptr             ? part.machine->next_timeout()
                                                                            : part.program->wakes());
    return earliest;
}

void BehaviourUnit::dispatch(std::size_t event, const std::byte* packed, Time now) noexcept TAPPET_REALTIME {
    limit_work(now);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const TriggerIndex trigger = routes_[event * parts_.size() + i].trigger;
        if (trigger == no_trigger) continue;
        has_worked_ = true;
        static_cast<void>(parts_[i].machine->dispatch(trigger, now, packed));
    }
    limit_.until = never;
    judge_gates();
}

} // namespace tappet

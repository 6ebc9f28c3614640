// A machine in its static memory: the places of its parts, as planned.
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/machine/plan/places.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

/// The parts exist once the machine is configured. Not real-time except where stated.
class PlacedMachine {
public:
    PlacedMachine(const AcceptedMachine& machine, os::Clock& clock) noexcept
        : machine_{machine}, clock_{&clock} {}
    PlacedMachine(const PlacedMachine&) = delete;
    PlacedMachine& operator=(const PlacedMachine&) = delete;

    [[nodiscard]] const AcceptedMachine& machine() const noexcept { return machine_; }
    [[nodiscard]] os::Clock& clock() noexcept { return *clock_; }
    /// Returns the engines, in the order of the table's activities. Real-time.
    [[nodiscard]] std::span<Engine> engines() noexcept TAPPET_REALTIME {
        return {at<Engine>(machine_.plan.engines_at), machine_.table.activities.size()};
    }
    [[nodiscard]] std::span<const Engine> engines() const noexcept TAPPET_REALTIME {
        return const_cast<PlacedMachine*>(this)->engines();
    }
    [[nodiscard]] std::span<std::byte> stack_of(std::size_t activity) noexcept;

    /// Returns a component by name, for worlds and tests; null when none has that name and type.
    template <class T>
    [[nodiscard]] T* find(std::string_view name) noexcept {
        const std::size_t c = find_component(machine_.table, name);
        return c != nowhere && machine_.table.components[c].type->tag == type_id<T>
                   ? static_cast<T*>(component(c))
                   : nullptr;
    }
    [[nodiscard]] void* component(std::size_t index) noexcept {
        TAPPET_CONTRACT(index < machine_.table.components.size(), Contract::index_out_of_range, index,
                        machine_.table.components.size());
        return machine_.memory.data() + machine_.plan.component_at[index];
    }
    /// Returns the member of a component that a facet names.
    [[nodiscard]] void* facet(End end) noexcept;
    /// Like facet(); null for a facet that is no member (an operation).
    [[nodiscard]] void* place_of(End end) noexcept {
        return facet_at(machine_.table, end).at == nullptr ? nullptr : facet(end);
    }

    /// Visits each row of a driver whose values did not all go to the wire as they were written, or were not
    /// all numbers when they came: tell(component, facet, Unsent). Any thread.
    template <class Tell>
    void each_unsent(const Tell& tell) {
        const auto rows = machine_.table.components;
        for (std::size_t c = 0; c < rows.size(); ++c)
            for (std::size_t f = 0; rows[c].type->unsent != nullptr && f < rows[c].type->facets.size(); ++f)
                if (const Unsent seen = rows[c].type->unsent(component(c), f);
                    seen.clamped + seen.no_number != 0)
                    tell(rows[c].name, rows[c].type->facets[f], seen);
    }

    /// Returns the behaviour that drives a component: that of the table's row, or the one loaded in its
    /// place; null: none.
    [[nodiscard]] const BehaviourUnit* behaviour_of(std::string_view component) const noexcept;
    /// Returns the unit of a behaviour row; null: the row is a slot, or has no unit.
    [[nodiscard]] BehaviourUnit* unit_of_row(std::size_t behaviour) noexcept {
        const std::size_t place = machine_.plan.behaviours[behaviour].unit_at;
        return place == nowhere ? nullptr : at<BehaviourUnit>(place);
    }
    [[nodiscard]] BehaviourSlot* slot_of_row(std::size_t behaviour) noexcept {
        const std::size_t place = machine_.plan.behaviours[behaviour].slot_at;
        return place == nowhere ? nullptr : at<BehaviourSlot>(place);
    }
    /// Returns the slot reserved for a component; null: none.
    [[nodiscard]] BehaviourSlot* slot_of(std::string_view component) noexcept;
    [[nodiscard]] const BehaviourSlot* slot_of(std::string_view component) const noexcept {
        return const_cast<PlacedMachine*>(this)->slot_of(component);
    }
    /// Returns the first state machine of that behaviour; null: none.
    [[nodiscard]] const StateMachineExecution* state_machine_of(std::string_view component) const noexcept;

    // ---- for builders and observers of the machine

    /// Returns the object that the plan placed at `offset`. Real-time.
    template <class T>
    [[nodiscard]] T* at(std::size_t offset) noexcept TAPPET_REALTIME {
        return reinterpret_cast<T*>(machine_.memory.data() + offset);
    }
    template <class T>
    [[nodiscard]] const T* at(std::size_t offset) const noexcept TAPPET_REALTIME {
        return reinterpret_cast<const T*>(machine_.memory.data() + offset);
    }
    template <class T>
    [[nodiscard]] std::span<T> at(const PlacesOf<T>& places) noexcept TAPPET_REALTIME {
        return {at<T>(places.at), places.count};
    }
    /// Returns the memory of a section that another folder adds to the table.
    [[nodiscard]] std::span<std::byte> extra_memory(std::size_t section) const noexcept;
    /// Returns the gate by which everything but its engine enters a component. Real-time.
    [[nodiscard]] GatedComponent* gate_of(std::size_t component) noexcept TAPPET_REALTIME;
    /// Returns the waker of an activity for a new value. A periodic activity is not woken: it reads the value
    /// in its next period. Real-time.
    [[nodiscard]] Waker waker_of(std::size_t activity) noexcept TAPPET_REALTIME;
    /// Like waker_of(), for a caller that has just posted to an inbox of that activity. Real-time.
    [[nodiscard]] Waker post_waker_of(std::size_t activity) noexcept TAPPET_REALTIME;

private:
    AcceptedMachine machine_;
    os::Clock* clock_;
};

} // namespace tappet

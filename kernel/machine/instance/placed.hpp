// A machine in its static memory: where the plan put each part of it.
#pragma once

#include "kernel/base/contract.hpp"
#include "kernel/machine/plan/places.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

/// The parts are there once the machine is configured. Not real-time but for what says so.
class PlacedMachine {
public:
    PlacedMachine(const AcceptedMachine& machine, os::Clock& clock) noexcept
        : machine_{machine}, clock_{&clock} {}
    PlacedMachine(const PlacedMachine&) = delete;
    PlacedMachine& operator=(const PlacedMachine&) = delete;

    [[nodiscard]] const AcceptedMachine& machine() const noexcept { return machine_; }
    [[nodiscard]] os::Clock& clock() noexcept { return *clock_; }
    /// In the order of the table's activities. Real-time.
    [[nodiscard]] std::span<Engine> engines() noexcept TAPPET_REALTIME {
        return {at<Engine>(machine_.plan.engines_at), machine_.table.activities.size()};
    }
    [[nodiscard]] std::span<const Engine> engines() const noexcept TAPPET_REALTIME {
        return const_cast<PlacedMachine*>(this)->engines();
    }
    [[nodiscard]] std::span<std::byte> stack_of(std::size_t activity) noexcept;

    /// A component by name, for worlds and tests; null when there is none of that name and type.
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
    /// The member of a component that a facet names.
    [[nodiscard]] void* facet(End end) noexcept;
    /// The same; null for what is no member (an operation).
    [[nodiscard]] void* place_of(End end) noexcept {
        return facet_at(machine_.table, end).at == nullptr ? nullptr : facet(end);
    }

    /// What the table's row says that drives a component, or was loaded in its place; null when none does.
    [[nodiscard]] const BehaviourUnit* behaviour_of(std::string_view component) const noexcept;
    /// Of a behaviour row; null: it is a slot, or it is none.
    [[nodiscard]] BehaviourUnit* unit_of_row(std::size_t behaviour) noexcept {
        const std::size_t place = machine_.plan.behaviours[behaviour].unit_at;
        return place == nowhere ? nullptr : at<BehaviourUnit>(place);
    }
    [[nodiscard]] BehaviourSlot* slot_of_row(std::size_t behaviour) noexcept {
        const std::size_t place = machine_.plan.behaviours[behaviour].slot_at;
        return place == nowhere ? nullptr : at<BehaviourSlot>(place);
    }
    /// The slot reserved for a component; null when there is none.
    [[nodiscard]] BehaviourSlot* slot_of(std::string_view component) noexcept;
    [[nodiscard]] const BehaviourSlot* slot_of(std::string_view component) const noexcept {
        return const_cast<PlacedMachine*>(this)->slot_of(component);
    }
    /// The first state machine of that; null when there is none.
    [[nodiscard]] const StateMachineExecution* state_machine_of(std::string_view component) const noexcept;

    // ---- for what makes the machine and looks at it

    /// What the plan put at `offset`. Real-time.
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
    /// Of a section of another folder.
    [[nodiscard]] std::span<std::byte> extra_memory(std::size_t section) const noexcept;
    /// By which everybody but its engine enters a component. Real-time.
    [[nodiscard]] GatedComponent* gate_of(std::size_t component) noexcept TAPPET_REALTIME;
    /// What wakes an activity for a value. A periodic one is not woken: it looks at its next period.
    /// Real-time.
    [[nodiscard]] Waker waker_of(std::size_t activity) noexcept TAPPET_REALTIME;
    /// The same for whoever posted to an inbox of that activity just before. Real-time.
    [[nodiscard]] Waker post_waker_of(std::size_t activity) noexcept TAPPET_REALTIME;

private:
    AcceptedMachine machine_;
    os::Clock* clock_;
};

} // namespace tappet

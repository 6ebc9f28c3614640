// Access of a component with controls("...") in its row to what it controls.
#pragma once

#include "kernel/machine/slots/behaviour_slot.hpp"

namespace tappet {

class MachineLife;

/// The controlled component; when it has a slot, the unit is the one that is loaded there.
struct Controlled {
    MachineLife* life = nullptr;
    std::size_t component = 0;
    std::string_view name{};        ///< of the controlling component
    const Engine* engine = nullptr; ///< runs the behaviour and the controlling component
    BehaviourSlot* slot = nullptr;
    BehaviourUnit* unit = nullptr;
    std::size_t part = 0;
    const SlotTask* task = nullptr; ///< of the slot; null: it controls the first behaviour there

    /// Returns the active unit; null: no behaviour is loaded. In that engine. Real-time.
    [[nodiscard]] BehaviourUnit* active() const noexcept TAPPET_REALTIME {
        return slot != nullptr ? slot->active() : unit;
    }
    [[nodiscard]] UnitPart* behaviour() const noexcept TAPPET_REALTIME {
        if (slot == nullptr) return &unit->parts()[part];
        BehaviourUnit* const loaded = slot->active();
        if (loaded == nullptr) return nullptr;
        return task != nullptr ? &slot->part_of(*task) : &loaded->parts().front();
    }
};

} // namespace tappet

// What a component whose row says controls("...") is given.
#pragma once

#include "kernel/machine/slots/behaviour_slot.hpp"

namespace tappet {

class MachineLife;

/// Of the component that it controls; of one with a slot the unit is whatever is loaded there.
struct Controlled {
    MachineLife* life = nullptr;
    std::size_t component = 0;
    std::string_view name{};        ///< of the one that controls
    const Engine* engine = nullptr; ///< that runs the behaviour, and the one that controls it
    BehaviourSlot* slot = nullptr;
    BehaviourUnit* unit = nullptr;
    std::size_t part = 0;
    const SlotTask* task = nullptr; ///< of the slot; null: it takes the first behaviour there

    /// Null: no behaviour is loaded. In that engine. Real-time.
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

// The task of a slot: its requirements on the behaviours that are loaded there. Its properties are stored in
// the task, so that they stay when behaviours change: each behaviour receives them when it takes over, and
// its changes to them are visible there.
#pragma once

#include "kernel/machine/slots/behaviour_unit.hpp"

#include <span>

namespace tappet {

/// A behaviour as its task knows it, in constants.
struct TaskShape {
    const BehaviourInstance* instance = nullptr;
    const BehaviourType* type = nullptr;
    /// Numbers of the variables that are properties of the task, and of its result.
    std::span<const std::uint16_t> variables{};

    /// Returns the offset of a variable among the task's values.
    [[nodiscard]] static constexpr std::size_t place_of(const BehaviourType& type, std::size_t variable) {
        return std::size_t{type.tables.variables[variable].at} - type.tables.layout.constants;
    }
    /// Returns the bytes of the values of a task of this type.
    [[nodiscard]] static constexpr std::size_t value_bytes(const BehaviourType& type) {
        return std::size_t{type.tables.layout.variables} - type.tables.layout.constants;
    }
};

class SlotTask {
public:
    static constexpr std::size_t max_variables = 64;

    /// Memory of the task; must outlive the slot.
    struct Room {
        std::span<std::byte> values{};  ///< value_bytes()
        std::span<std::byte> seen{};    ///< as many bytes
        std::span<DataOffset> places{}; ///< of each variable, for both banks
    };
    /// Places the task, at start-up; the values are those of the shape. `name`: of the task's row.
    void place(std::string_view name, const TaskShape& shape, const Room& room) noexcept;

    /// Finds the behaviour and its variables in the unit that was loaded into a bank. The error names what is
    /// missing. In the background; not real-time.
    [[nodiscard]] Sentence fit(const ScriptUnit& unit, std::size_t bank);

    // In the engine that runs the slot, for the unit in a bank that fits; real-time.

    [[nodiscard]] UnitPart& part(BehaviourUnit& unit, std::size_t bank) const noexcept TAPPET_REALTIME {
        return unit.parts()[parts_[bank]];
    }
    enum class When : std::uint8_t { step, take_over, take_back };
    /// Makes properties and variables equal: a value set in the task goes to the behaviour, any other value
    /// goes to the task. A behaviour that takes over receives all values; one that returns receives those
    /// that were set since.
    void exchange(BehaviourUnit& unit, std::size_t bank, When when = When::step) noexcept TAPPET_REALTIME;

    SlotTask* next = nullptr; ///< of the same slot

private:
    std::string_view name_{};
    TaskShape shape_{};
    Room room_{};
    std::size_t parts_[2]{};
    std::uint64_t set_ = 0; ///< a bit for each variable that was set since the last take-over
};

} // namespace tappet

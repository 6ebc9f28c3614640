// What the task of a slot asks of the behaviours that are loaded there. Its properties lie in the task, so
// that they stay while behaviours come and go: each is given them when it takes over, and what it does with
// them is seen there.
#pragma once

#include "kernel/machine/slots/behaviour_unit.hpp"

#include <span>

namespace tappet {

/// A behaviour as its task knows it, in constants.
struct TaskShape {
    const BehaviourInstance* instance = nullptr;
    const BehaviourType* type = nullptr;
    /// Numbers of the variables that the task has as properties, and of its result.
    std::span<const std::uint16_t> variables{};

    /// Where a variable lies among the task's values.
    [[nodiscard]] static constexpr std::size_t place_of(const BehaviourType& type, std::size_t variable) {
        return std::size_t{type.tables.variables[variable].at} - type.tables.layout.constants;
    }
    /// What the values of a task of this type take.
    [[nodiscard]] static constexpr std::size_t value_bytes(const BehaviourType& type) {
        return std::size_t{type.tables.layout.variables} - type.tables.layout.constants;
    }
};

class SlotTask {
public:
    static constexpr std::size_t max_variables = 64;

    /// Memory of the task, which outlives the slot.
    struct Room {
        std::span<std::byte> values{};  ///< value_bytes()
        std::span<std::byte> seen{};    ///< so many
        std::span<DataOffset> places{}; ///< of each variable, twice
    };
    /// By start-up; the values are those of the shape. `name`: of the task's row.
    void place(std::string_view name, const TaskShape& shape, const Room& room) noexcept;

    /// Finds the behaviour and its variables in what was loaded into a bank. An error names what it does not
    /// have. In the background; not real-time.
    [[nodiscard]] Sentence fit(const ScriptUnit& unit, std::size_t bank);

    // In the engine that runs the slot, of the unit in a bank that fits; real-time.

    [[nodiscard]] UnitPart& part(BehaviourUnit& unit, std::size_t bank) const noexcept TAPPET_REALTIME {
        return unit.parts()[parts_[bank]];
    }
    enum class When : std::uint8_t { step, take_over, take_back };
    /// Properties and variables become the same: what was set in the task goes to the behaviour, of all else
    /// its value comes to the task. One that takes over is given them all, one that comes back what was set
    /// since.
    void exchange(BehaviourUnit& unit, std::size_t bank, When when = When::step) noexcept TAPPET_REALTIME;

    SlotTask* next = nullptr; ///< of the same slot

private:
    std::string_view name_{};
    TaskShape shape_{};
    Room room_{};
    std::size_t parts_[2]{};
    std::uint64_t set_ = 0; ///< of each variable whether it was, since the last one took over
};

} // namespace tappet

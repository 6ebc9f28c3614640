// The feedback control kernel (thesis chapter 3): a section of the machine table that gives components their
// roles in the control action. The compiler checks readers, writers and calls, that values written in turns
// have one writer at a time, and that the loops can be stable.
#pragma once

#include "kernel/control/chain_switch.hpp"
#include "kernel/control/check_flow.hpp"
#include "kernel/control/check_levels.hpp"
#include "kernel/control/check_loops.hpp"
#include "kernel/control/check_turns.hpp"
#include "kernel/control/turns.hpp"
#include "kernel/machine/table/section.hpp"

#include <array>
#include <concepts>
#include <span>

namespace tappet {

namespace control_detail {

constexpr Sentence check(const ControlView& c, const MachineView& m, const TableIndexView& r) {
    Seats seats;
    if (Sentence fault = take_seats(c, m, seats); !fault.empty()) return fault;
    if (Sentence fault = check_levels(c, m, r, seats); !fault.empty()) return fault;
    if (Sentence fault = check_turns(c, m, r, seats, &component_type<ChainSwitch>); !fault.empty())
        return fault;
    if (Sentence fault = check_data_flow(c, m, r, seats); !fault.empty()) return fault;
    return check_loops(c, m, r, seats);
}

void connect(const ControlView& control, MachineInstance& machine, std::size_t section,
             std::span<std::byte> memory);
Sentence describe_stop(const ControlView& control, std::size_t row);
SectionCount counted(const ControlView& control, std::span<const std::byte> memory, std::size_t row) noexcept;

template <class Row, class... Rows>
inline constexpr std::size_t count_of = (std::size_t{0} + ... + (std::same_as<Row, Rows> ? 1 : 0));

template <class Row, std::size_t N, class... Rows>
constexpr std::array<Row, N> rows_of(const Rows&... rows) {
    std::array<Row, N> found{};
    std::size_t at = 0;
    const auto take = [&](const auto& row) {
        if constexpr (std::same_as<std::remove_cvref_t<decltype(row)>, Row>) found[at++] = row;
    };
    (take(rows), ...);
    return found;
}

} // namespace control_detail

template <std::size_t Levels, std::size_t Processes, std::size_t Exclusives, std::size_t Loops>
struct Control final : ExtraSection {
    std::array<LevelRow, Levels> levels{};
    std::array<RoleRow, Processes> processes{};
    std::array<ExclusiveRow, Exclusives> exclusives{};
    std::array<LoopRow, Loops> loops{};

    [[nodiscard]] constexpr control_detail::ControlView view() const noexcept {
        return {levels, processes, exclusives, loops};
    }
    [[nodiscard]] constexpr bool take_turns(const MachineView& m, std::size_t one,
                                            std::size_t other) const override {
        return control_detail::take_turns(exclusives, m.components[one].name, m.components[other].name);
    }
    /// A component in a loop waits for all its inputs except those of the step before: an invalid zero would
    /// move the axis (thesis 3.1.3: starting).
    [[nodiscard]] constexpr bool awaits(const MachineView& m, std::size_t from,
                                        std::size_t to) const override {
        control_detail::Seats seats;
        static_cast<void>(control_detail::take_seats(view(), m, seats).empty()); // was checked
        if (control_detail::level_of(seats, to) == control_detail::no_level) return false;
        const control_detail::DataPath* path = control_detail::path_between(seats, from, to);
        return path == nullptr || !path->of_last_step;
    }
    [[nodiscard]] constexpr Sentence check(const MachineView& m, const TableIndexView& r) const override {
        return control_detail::check(view(), m, r);
    }
    [[nodiscard]] constexpr std::size_t bytes(const MachineView&) const override {
        return Exclusives * sizeof(control_detail::Turns);
    }
    void connect(MachineInstance& machine, std::size_t number, std::span<std::byte> memory) const override {
        control_detail::connect(view(), machine, number, memory);
    }
    [[nodiscard]] Sentence describe_stop(std::size_t row) const override {
        return control_detail::describe_stop(view(), row);
    }
    [[nodiscard]] SectionCount counted(std::span<const std::byte> memory,
                                       std::size_t row) const noexcept override {
        return control_detail::counted(view(), memory, row);
    }
};

/// The section: rows of level(..), process(..), exclusive(..) and loop(..).
template <class... Rows>
constexpr auto control(const Rows&... rows) {
    using namespace control_detail;
    static_assert(
        ((std::same_as<Rows, LevelRow> || std::same_as<Rows, RoleRow> || std::same_as<Rows, ExclusiveRow> ||
          std::same_as<Rows, LoopRow>) &&
         ...),
        "control(...) has rows of level(...), process(...), exclusive(...) and loop(...); a Sensor, "
        "Estimator, Generator, Controller or Effector stands in a level, a chain in exclusive(...)");
    Control<count_of<LevelRow, Rows...>, count_of<RoleRow, Rows...>, count_of<ExclusiveRow, Rows...>,
            count_of<LoopRow, Rows...>>
        section;
    section.levels = rows_of<LevelRow, count_of<LevelRow, Rows...>>(rows...);
    section.processes = rows_of<RoleRow, count_of<RoleRow, Rows...>>(rows...);
    section.exclusives = rows_of<ExclusiveRow, count_of<ExclusiveRow, Rows...>>(rows...);
    section.loops = rows_of<LoopRow, count_of<LoopRow, Rows...>>(rows...);
    return section;
}

} // namespace tappet

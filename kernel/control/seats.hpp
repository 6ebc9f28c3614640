// The rows of the control kernel with names resolved: the roles of each component.
#pragma once

#include "kernel/control/rows.hpp"
#include "kernel/machine/table/index.hpp"

#include <span>

namespace tappet::control_detail {

/// The rows by kind, in the order of the table.
struct ControlView {
    std::span<const LevelRow> levels;
    std::span<const RoleRow> processes;
    std::span<const ExclusiveRow> exclusives;
    std::span<const LoopRow> loops;
};

/// Returns the role's name with its article.
constexpr std::string_view a_role(ControlRole role) noexcept {
    switch (role) {
    case ControlRole::sensor: return "a Sensor";
    case ControlRole::estimator: return "an Estimator";
    case ControlRole::generator: return "a Generator";
    case ControlRole::controller: return "a Controller";
    case ControlRole::effector: return "an Effector";
    case ControlRole::process: return "a process component";
    }
    return "?";
}

constexpr std::string_view to_text(ControlRole role) noexcept {
    const std::string_view text = a_role(role);
    return text.substr(text.find(' ') + 1);
}

inline constexpr std::size_t no_level = static_cast<std::size_t>(-1);

/// A component in a role. A component with two merged roles has two seats.
struct Seat {
    std::size_t component = nowhere;
    ControlRole role = ControlRole::process;
    std::size_t level = no_level;
    std::string_view tracked{};
};

inline constexpr std::size_t max_seats = 96;
using Seats = Bounded<Seat, max_seats>;

template <class... Pieces>
constexpr Sentence of_level(const LevelRow& row, const Pieces&... fault) {
    return Sentence{"level \"", row.name, "\": ", fault...};
}

constexpr Sentence too_many(std::string_view what, std::size_t most) {
    return Sentence{"it has more than ", most, " ", what, "; split it in two"};
}

/// Fills the seats; returns the first unknown name as a fault.
constexpr Sentence take_seats(const ControlView& c, const MachineView& m, Seats& seats) {
    const auto seat = [&](const RoleRow& role, std::size_t level) -> Sentence {
        const std::size_t component = find_component(m, role.component);
        if (component == nowhere) return unknown_component(m, role.component);
        for (const Seat& each : seats) {
            if (each.component != component) continue;
            if (each.role == role.role)
                return Sentence{"\"", role.component, "\" is ", a_role(role.role),
                                " twice; name it once, and read it where it is needed"};
            if (each.role == ControlRole::process || role.role == ControlRole::process)
                return Sentence{
                    "\"", role.component,
                    "\" is part of the data flow and cannot also be a process component; name it once"};
            if (each.level != level)
                return Sentence{"\"", role.component, "\" is in level \"", c.levels[each.level].name,
                                "\" already; a component runs in one level"};
        }
        if (!seats.push({component, role.role, level, role.tracked})) return too_many("roles", max_seats);
        return {};
    };
    for (std::size_t l = 0; l < c.levels.size(); ++l) {
        const LevelRow& row = c.levels[l];
        if (row.too_many) return of_level(row, too_many("components", LevelRow::max_roles));
        for (std::size_t before = 0; before < l; ++before)
            if (same_text(c.levels[before].name, row.name))
                return of_level(row, "another level has this name; rename one");
        for (const RoleRow& role : row.roles) {
            if (role.role == ControlRole::process)
                return of_level(row, "\"", role.component,
                                "\" is a process component, which serves all levels; write it beside the "
                                "levels, in control(...)");
            if (Sentence fault = seat(role, l); !fault.empty()) return of_level(row, fault);
        }
    }
    for (const RoleRow& role : c.processes) {
        if (role.role != ControlRole::process)
            return Sentence{"control: \"", role.component, "\" is ", a_role(role.role),
                            " outside of a level; move it into a level(...)"};
        if (Sentence fault = seat(role, no_level); !fault.empty()) return Sentence{"control: ", fault};
    }
    return {};
}

constexpr bool has_seat(const Seats& seats, std::size_t component) noexcept {
    for (const Seat& each : seats)
        if (each.component == component) return true;
    return false;
}

/// Returns the level of a component; no_level: it has no role in one.
constexpr std::size_t level_of(const Seats& seats, std::size_t component) noexcept {
    for (const Seat& each : seats)
        if (each.component == component) return each.level;
    return no_level;
}

/// Returns a bit for each chain of an exclusive row that contains the component.
constexpr unsigned chains_of(const ExclusiveRow& row, std::string_view component) noexcept {
    unsigned in = 0;
    for (std::size_t i = 0; i < row.chains.size(); ++i)
        for (const std::string_view member : row.chains[i].members)
            if (same_text(member, component)) in |= 1u << i;
    return in;
}

/// Returns whether both are members of one row, and no chain contains both.
constexpr bool take_turns(std::span<const ExclusiveRow> rows, std::string_view one,
                          std::string_view other) noexcept {
    for (const ExclusiveRow& row : rows) {
        const unsigned a = chains_of(row, one), b = chains_of(row, other);
        if (a != 0 && b != 0 && (a & b) == 0) return true;
    }
    return false;
}

} // namespace tappet::control_detail

// Checks of levels: each runs in one periodic activity and has what a control action needs; the periods of a
// cascade fit each other (thesis 3.1.2, 3.1.3, 3.2.3).
#pragma once

#include "kernel/control/seats.hpp"
#include "kernel/machine/check/time.hpp"

namespace tappet::control_detail {

/// Returns the activity of a level, which is that of its first component.
constexpr std::size_t activity_of_level(const LevelRow& row, const MachineView& m,
                                        const TableIndexView& r) noexcept {
    return r.activity[find_component(m, row.roles[0].component)];
}

/// One thread for each level, serialised (thesis 3.2.3).
constexpr Sentence check_activity(const LevelRow& row, const MachineView& m, const TableIndexView& r) {
    const std::size_t own = activity_of_level(row, m, r);
    for (const RoleRow& role : row.roles) {
        const std::size_t other = r.activity[find_component(m, role.component)];
        if (other != own)
            return of_level(row, "\"", row.roles[0].component, "\" runs in activity \"",
                            m.activities[own].name, "\", but \"", role.component, "\" in \"",
                            m.activities[other].name,
                            "\"; let one activity run all of a level, so that each sees this step's values");
    }
    const ActivityRow& activity = m.activities[own];
    if (activity.trigger != Trigger::every || !activity.real_time)
        return of_level(row, "its activity \"", activity.name,
                        "\" is not a periodic real-time activity, which control needs; write every(...)");
    return {};
}

constexpr bool has_role(const Seats& seats, std::size_t level, ControlRole role) noexcept {
    for (const Seat& each : seats)
        if (each.level == level && each.role == role) return true;
    return false;
}

/// A level without these is insufficient (thesis: a component fails to load in an insufficient kernel).
constexpr Sentence check_complete(const ControlView& c, const Seats& seats) {
    bool has_sensor = false;
    for (std::size_t l = 0; l < c.levels.size(); ++l) {
        has_sensor |= has_role(seats, l, ControlRole::sensor);
        if (!has_role(seats, l, ControlRole::controller))
            return of_level(c.levels[l],
                            "it has no Controller, which makes outputs of set points and inputs; "
                            "add controller(\"...\")");
        if (l + 1 == c.levels.size() && !has_role(seats, l, ControlRole::effector))
            return of_level(c.levels[l],
                            "it is the innermost and has no Effector, so that nothing reaches the "
                            "hardware; add effector(\"...\")");
    }
    if (!has_sensor)
        return Sentence{"control: no level has a Sensor, so that nothing is fed back; add sensor(\"...\")"};
    return {};
}

/// An outer level commands the next inner one, which is as fast, or faster by an integer factor.
constexpr Sentence check_rates(const ControlView& c, const MachineView& m, const TableIndexView& r) {
    for (std::size_t l = 1; l < c.levels.size(); ++l) {
        const Duration outer = m.activities[activity_of_level(c.levels[l - 1], m, r)].period;
        const Duration inner = m.activities[activity_of_level(c.levels[l], m, r)].period;
        if (outer < inner)
            return of_level(c.levels[l], "it runs every ", checks::in_us(inner.count()),
                            ", slower than level \"", c.levels[l - 1].name, "\" above it, which runs every ",
                            checks::in_us(outer.count()),
                            "; an inner loop must not be slower: exchange the levels, or their periods");
        if (outer % inner != Duration::zero())
            return of_level(c.levels[l], "its period of ", checks::in_us(inner.count()),
                            " does not divide that of level \"", c.levels[l - 1].name, "\" above it, ",
                            checks::in_us(outer.count()),
                            ", so that commands would hold for different numbers of steps; choose periods of "
                            "which one is a multiple of the other");
    }
    return {};
}

constexpr Sentence check_levels(const ControlView& c, const MachineView& m, const TableIndexView& r,
                                const Seats& seats) {
    if (c.levels.empty())
        return Sentence{"control: it has no level, and so no loop; add level(\"...\", ...)"};
    for (const LevelRow& row : c.levels) {
        if (row.roles.empty())
            return of_level(row, "it names no component; give it its Sensor, Generator, "
                                 "Controller and Effector");
        if (Sentence fault = check_activity(row, m, r); !fault.empty()) return fault;
    }
    if (Sentence fault = check_complete(c, seats); !fault.empty()) return fault;
    return check_rates(c, m, r);
}

} // namespace tappet::control_detail

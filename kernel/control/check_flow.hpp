// Checks of the data flow between roles (thesis 3.1.2, 3.1.3): who may read and call what, and that every
// component leaves safe values behind.
#pragma once

#include "kernel/control/seats.hpp"
#include "kernel/machine/check/flow.hpp"
#include "kernel/machine/check/operations.hpp"

namespace tappet::control_detail {

/// From a level's point of view: the place of the reader.
enum class Reader : std::uint8_t { same_level, any_level, level_below };

struct DataPath {
    ControlRole from;
    ControlRole to;
    Reader where;
    std::string_view what;
    bool of_last_step = false; ///< within one activity the row says delayed
};

/// All permitted data flow (thesis figures 3.1 and 3.6). Any other path is refused.
inline constexpr DataPath data_paths[] = {
    {ControlRole::sensor, ControlRole::estimator, Reader::any_level, "inputs"},
    {ControlRole::sensor, ControlRole::generator, Reader::any_level, "inputs"},
    {ControlRole::sensor, ControlRole::controller, Reader::any_level, "inputs"},
    {ControlRole::estimator, ControlRole::estimator, Reader::any_level, "the model"},
    {ControlRole::estimator, ControlRole::generator, Reader::any_level, "the model"},
    {ControlRole::estimator, ControlRole::controller, Reader::any_level, "the model"},
    {ControlRole::generator, ControlRole::controller, Reader::same_level, "set points"},
    {ControlRole::controller, ControlRole::effector, Reader::same_level, "outputs"},
    {ControlRole::controller, ControlRole::generator, Reader::level_below, "commands"},
    {ControlRole::controller, ControlRole::estimator, Reader::any_level, "outputs", true},
    {ControlRole::effector, ControlRole::estimator, Reader::any_level, "what was sent", true},
    {ControlRole::effector, ControlRole::controller, Reader::any_level, "what was sent", true},
    {ControlRole::effector, ControlRole::generator, Reader::any_level, "what was sent", true},
};

/// Frequent mistakes and their corrections.
struct WrongPath {
    ControlRole from;
    ControlRole to;
    std::string_view cure;
};
inline constexpr WrongPath wrong_paths[] = {
    {ControlRole::sensor, ControlRole::effector,
     "put a Controller between them, which turns inputs into outputs"},
    {ControlRole::estimator, ControlRole::effector,
     "put a Controller between them, which turns the model into outputs"},
    {ControlRole::generator, ControlRole::effector,
     "put a Controller between them, even if it only passes set points on"},
    {ControlRole::generator, ControlRole::generator,
     "merge both into one Generator, or let a Controller of the level above command it"},
    {ControlRole::generator, ControlRole::estimator,
     "an Estimator reads inputs and the outputs of the previous step; connect those"},
    {ControlRole::controller, ControlRole::controller,
     "make two levels of it: the outer Controller commands the inner Generator"},
    {ControlRole::controller, ControlRole::generator,
     "a Controller commands the Generator of the level directly below its own; connect that one, if there is "
     "one"},
    {ControlRole::controller, ControlRole::effector,
     "a level has its own Controller; let the outer one command the inner Generator"},
    {ControlRole::generator, ControlRole::controller,
     "set points stay in their level; let a Controller of the outer level command the inner Generator"},
};

constexpr bool reaches(const DataPath& path, const Seat& from, const Seat& to) noexcept {
    if (path.from != from.role || path.to != to.role) return false;
    if (path.where == Reader::same_level) return from.level == to.level;
    return path.where == Reader::any_level || to.level == from.level + 1;
}

/// Returns the path by any of the roles of the two components; null: nothing flows there.
constexpr const DataPath* path_between(const Seats& seats, std::size_t from, std::size_t to) noexcept {
    for (const Seat& a : seats)
        for (const Seat& b : seats) {
            if (a.component != from || b.component != to) continue;
            for (const DataPath& path : data_paths)
                if (reaches(path, a, b)) return &path;
        }
    return nullptr;
}

constexpr const Seat& seat_of(const Seats& seats, std::size_t component) noexcept {
    for (const Seat& each : seats)
        if (each.component == component) return each;
    return seats[0];
}

constexpr Sentence refuse_path(const ControlView& c, const ConnectionRow& row, const Seat& from,
                               const Seat& to) {
    Sentence text = checks::of_connection(row, ": ", a_role(from.role));
    if (from.level != to.level) text.add(" of level \"").add(c.levels[from.level].name).add("\"");
    text.add(" must not write to ").add(a_role(to.role));
    if (from.level != to.level) text.add(" of level \"").add(c.levels[to.level].name).add("\"");
    text.add("; ");
    for (const WrongPath& each : wrong_paths)
        if (each.from == from.role && each.to == to.role) return text.add(each.cure);
    if (to.role == ControlRole::sensor)
        return text.add(
            "a Sensor reads hardware only; connect its input to a driver, or leave it out if it is optional");
    return text.add("let a Controller write the value");
}

constexpr bool is_driver(const MachineView& m, std::size_t component) noexcept {
    return m.components[component].type->device_kind != nullptr;
}

/// At least one end has a role.
constexpr Sentence check_outside(const ConnectionRow& row, const MachineView& m, const Seats& seats,
                                 std::size_t from, std::size_t to) {
    const bool from_seat = has_seat(seats, from), to_seat = has_seat(seats, to);
    if (!from_seat) {
        for (const Seat& each : seats)
            if (each.component == to &&
                (each.role == ControlRole::sensor || each.role == ControlRole::process))
                return {};
        return checks::of_connection(
            row, ": a value from outside of control(...) must enter through a Sensor, but \"",
            m.components[to].name, "\" is ", a_role(seat_of(seats, to).role), "; give \"",
            m.components[from].name, "\" a role in control(...), or read the value with a Sensor");
    }
    if (to_seat) return {};
    for (const Seat& each : seats)
        if (each.component == from &&
            (each.role == ControlRole::effector || each.role == ControlRole::process))
            return {};
    if (is_driver(m, to))
        return checks::of_connection(row,
                                     ": only an Effector may write to hardware, within its limits, but \"",
                                     m.components[from].name, "\" is ", a_role(seat_of(seats, from).role),
                                     "; let it write to an Effector");
    return checks::of_connection(row, ": \"", m.components[to].name,
                                 "\" has no role in control(...), so that the value cannot be followed "
                                 "further; if it only observes, add process(...)");
}

constexpr Sentence check_row(const ControlView& c, const MachineView& m, const TableIndexView& r,
                             const Seats& seats, std::size_t x) {
    const ConnectionRow& row = m.connections[x];
    const std::size_t from = r.connections[x].from.component, to = r.connections[x].to.component;
    const bool crosses = r.activity[from] != r.activity[to];
    if (level_of(seats, from) == no_level && level_of(seats, to) == no_level) return {}; // no loop
    const bool is_looked_at =
        has_seat(seats, to) && level_of(seats, to) == no_level; // by a process component
    if (crosses && !row.buffered && row.max_age == Duration::zero() && !is_looked_at)
        return checks::of_connection(
            row, ": it leads from activity \"", m.activities[r.activity[from]].name, "\" to \"",
            m.activities[r.activity[to]].name,
            "\" in a loop but does not say what to do when the writer falls silent; add "
            "stale_after(...) with hold, substitute(...) or stop_machine");
    if (!has_seat(seats, from) || !has_seat(seats, to)) return check_outside(row, m, seats, from, to);
    const Seat& writer = seat_of(seats, from);
    const Seat& reader = seat_of(seats, to);
    if (writer.role == ControlRole::process && reader.role != ControlRole::process)
        return checks::of_connection(
            row, ": a process component may read the data flow but must not write to it; let \"",
            m.components[from].name, "\" command \"", m.components[to].name, "\" with an operation");
    if (writer.role == ControlRole::process || reader.role == ControlRole::process) return {};
    const DataPath* path = path_between(seats, from, to);
    if (path == nullptr) return refuse_path(c, row, writer, reader);
    if (path->of_last_step && !crosses && !row.delayed_step)
        return checks::of_connection(row, ": ", a_role(path->to), " reads ", path->what,
                                     " only from the previous step; add delayed");
    if (writer.level != reader.level && path->from == ControlRole::controller &&
        path->to == ControlRole::generator && row.transition == RateTransition::unsaid &&
        m.activities[r.activity[from]].period != m.activities[r.activity[to]].period)
        return checks::of_connection(row,
                                     ": it does not say how the faster level reads a command of the slower "
                                     "one; add in_steps, interpolated (one period later) or extrapolated");
    return {};
}

/// Data-flow components call process components and services; process components call any component (thesis
/// 3.1.3).
constexpr Sentence check_calls(const MachineView& m, const TableIndexView& r, const Seats& seats) {
    for (std::size_t i = 0; i < m.reactions.size(); ++i) {
        const ReactionRow& row = m.reactions[i];
        if (row.kind == ReactionKind::when) continue;
        const std::size_t from = r.reactions[i].from.component, to = r.reactions[i].to.component;
        if (!has_seat(seats, from) || !has_seat(seats, to)) continue;
        const Seat& caller = seat_of(seats, from);
        const Seat& called = seat_of(seats, to);
        if (caller.role == ControlRole::process || called.role == ControlRole::process) continue;
        return Sentence{checks::of_use(row),
                        ": ",
                        a_role(caller.role),
                        " must not call ",
                        a_role(called.role),
                        ", so that each can be replaced alone; call it from a process component, or exchange "
                        "the value through ports"};
    }
    return {};
}

/// Each component writes for a reader, reads from a writer, and leaves safe values when it stops.
constexpr Sentence check_seat(const ControlView& c, const MachineView& m, const TableIndexView& r,
                              const Seats& seats, const Seat& seat) {
    const LevelRow& level = c.levels[seat.level];
    const std::string_view name = m.components[seat.component].name;
    bool reads = false, writes = false;
    for (std::size_t x = r.connections_into.first[seat.component]; x != nowhere;
         x = r.connections_into.next[x])
        reads |= has_seat(seats, r.connections[x].from.component);
    for (std::size_t x = r.connections_from.first[seat.component]; x != nowhere;
         x = r.connections_from.next[x])
        writes = true;
    if (!reads && seat.role != ControlRole::sensor)
        return of_level(level, "no connection leads to the ", to_text(seat.role), " \"", name,
                        "\"; connect one of its inputs");
    if (!writes && (seat.role != ControlRole::effector || !is_driver(m, seat.component)))
        return of_level(level, "no component reads the outputs of the ", to_text(seat.role), " \"", name,
                        "\"; connect one of them, or leave it out");
    const ComponentType& type = *m.components[seat.component].type;
    const bool says_so =
        seat.role == ControlRole::sensor && std::ranges::any_of(type.facets, [](const Facet& each) {
            return each.at_rest >= AtRest::says_false;
        });
    if (writes && type.stop == nullptr && !says_so && !is_driver(m, seat.component))
        return of_level(
            level, "the ", to_text(seat.role), " \"", name,
            "\" has no stop(), so that its readers would continue with its last value after it stopped; add "
            "one that writes safe values: void stop(const Cycle&) noexcept TAPPET_REALTIME");
    return {};
}

constexpr Sentence check_data_flow(const ControlView& c, const MachineView& m, const TableIndexView& r,
                                   const Seats& seats) {
    for (std::size_t x = 0; x < m.connections.size(); ++x)
        if (Sentence fault = check_row(c, m, r, seats, x); !fault.empty()) return fault;
    if (Sentence fault = check_calls(m, r, seats); !fault.empty()) return fault;
    for (const Seat& seat : seats)
        if (seat.level != no_level)
            if (Sentence fault = check_seat(c, m, r, seats, seat); !fault.empty()) return fault;
    return {};
}

} // namespace tappet::control_detail

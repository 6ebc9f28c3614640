// Checks of the section connections: both ends exist, have the right direction and the same type; every input
// has one writer; each activity has an order in which every component sees this cycle's values.
#pragma once

#include "kernel/machine/check/components.hpp"
#include "kernel/machine/check/units.hpp"

namespace tappet::checks {

/// Far above any board's memory, and small enough that no sum of the plan overflows.
inline constexpr std::size_t most_buffered = 1 << 24;

template <class... Pieces>
constexpr Sentence of_connection(const ConnectionRow& row, const Pieces&... fault) {
    return Sentence{"connection \"", row.from, "\" -> \"", row.to, "\"", fault...};
}

constexpr Sentence check_direction(const ConnectionRow& row, const Facet& from, const Facet& to) {
    const bool from_is_input = from.kind == FacetKind::input || from.kind == FacetKind::buffer_input;
    const bool to_is_output = to.kind == FacetKind::output || to.kind == FacetKind::buffer_output;
    if (from_is_input && to_is_output)
        return of_connection(row, " runs from an input to an output; exchange the two");
    const FacetKind wanted_from = row.buffered ? FacetKind::buffer_output : FacetKind::output;
    const FacetKind wanted_to = row.buffered ? FacetKind::buffer_input : FacetKind::input;
    if (from.kind != wanted_from)
        return of_connection(row, ": \"", row.from, "\" is ", to_text(from.kind), ", not ",
                             to_text(wanted_from),
                             from.kind == FacetKind::buffer_output ? "; write buffer<n>(...)"
                             : from.kind == FacetKind::output      ? "; write data(...)"
                                                                   : "; name an output first");
    if (to.kind != wanted_to)
        return of_connection(row, ": \"", row.to, "\" is ", to_text(to.kind), ", not ", to_text(wanted_to),
                             to.kind == FacetKind::buffer_input ? "; write buffer<n>(...)"
                             : to.kind == FacetKind::input      ? "; write data(...)"
                                                                : "; name an input second");
    if (from.type != to.type)
        return of_connection(row, ": \"", row.from, "\" is of type ", from.type->name, " but \"", row.to,
                             "\" is of type ", to.type->name, "; connect ports of one type");
    return {};
}

/// Checks a row that scales: the ends are floating-point numbers, and the factor fits their units.
constexpr Sentence check_scale(const ConnectionRow& row, const Facet& from, const Facet& to) {
    if (row.buffered || to.type->kind != ValueKind::real || !to.type->arithmetic)
        return of_connection(row, ": ", row.buffered ? "a buffer" : to.type->name,
                             " cannot be scaled, only a port of double or float; convert it in a component");
    if (row.says_scale && !(is_number(row.scale) && row.scale != 0))
        return of_connection(row,
                             ": the factor in scaled is not a finite number other than 0; write another");
    if (row.scale != 0 && row.converted)
        return of_connection(row, " has both scaled and converted; keep one");
    const Unit source = parse_unit(from.unit), target = parse_unit(to.unit);
    if (!converts(source, target) || (row.converted && (from.unit.empty() || to.unit.empty())))
        return row.converted
                   ? of_connection(row, ": there is no conversion from ", in_unit(from), " to ", in_unit(to),
                                   "; write scaled(factor) if you know one, or correct a unit")
                   : Sentence{};
    if (row.converted) return {};
    const double ratio = row.scale * target.size / source.size;
    if (from.unit.empty() || to.unit.empty() || (ratio > 1 - 1e-6 && ratio < 1 + 1e-6)) return {};
    return of_connection(row, ": its factor does not convert ", in_unit(from), " to ", in_unit(to),
                         "; write converted, and the compiler computes it");
}

/// Checks the units. An end without a unit accepts any: a generic component and a raw signal cannot know it;
/// --plan lists them. "1" is the unit of a dimensionless value, and differs from no unit.
constexpr Sentence check_units(const ConnectionRow& row, const Facet& from, const Facet& to) {
    if (is_scaled(row) || row.says_scale) return check_scale(row, from, to);
    if (from.unit == to.unit || from.unit.empty() || to.unit.empty()) return {};
    const Unit source = parse_unit(from.unit), target = parse_unit(to.unit);
    const bool one_kind = converts(source, target);
    if (one_kind && source.same(target)) return {};
    return of_connection(
        row, ": \"", row.from, "\" is in ", from.unit, " but \"", row.to, "\" in ", to.unit,
        !one_kind ? "; connect ports of one unit, or correct the unit of one of them"
        : !row.buffered && to.type->kind == ValueKind::real && to.type->arithmetic
            ? ", another unit of the same quantity; add converted to the row"
            : ", another unit of the same quantity; convert it in one of the two components");
}

constexpr Sentence no_number_in(const ConnectionRow& row, std::string_view option) {
    return of_connection(row, ": the value in ", option, " is not a finite number; write a finite one");
}

constexpr Sentence check_row_value(const ConnectionRow& row, std::string_view option, const RowValue& value,
                                   const Facet& to) {
    if (!value.given) return {};
    if (!is_number(value.number)) return no_number_in(row, option);
    if (value.constant != nullptr)
        return value.type == to.type ? Sentence{}
                                     : of_connection(row, ": ", option, " gives a value of type ",
                                                     value.type->name, ", but \"", row.to, "\" is of type ",
                                                     to.type->name, "; name a constant of the port's type");
    if (!to.type->arithmetic)
        return of_connection(row, ": a value of type ", to.type->name, " is not a number; write ", option,
                             "<constant>() with a constant of that type");
    if (!holds(*to.type, value.number))
        return of_connection(row, ": the number in ", option, " does not fit \"", row.to, "\" of type ",
                             to.type->name, "; write one that it can hold");
    return {};
}

/// Checks a row between two rates: both ends have a period, and one is a multiple of the other.
constexpr Sentence check_transition(const MachineView& m, const ConnectionRow& row, const Facet& to,
                                    std::size_t writer, std::size_t reader) {
    if (row.transition == RateTransition::unsaid) return {};
    const ActivityRow& from = m.activities[writer];
    const ActivityRow& into = m.activities[reader];
    if (from.trigger != Trigger::every || into.trigger != Trigger::every || into.period >= from.period ||
        from.period % into.period != Duration::zero())
        return of_connection(row,
                             ": in_steps, interpolated and extrapolated need a writer whose period is a "
                             "larger multiple of the reader's; this is not the case from activity \"",
                             from.name, "\" to activity \"", into.name,
                             "\"; remove the option, or change a period");
    if (has_values_between(row) && (row.buffered || to.type->kind != ValueKind::real || !to.type->arithmetic))
        return of_connection(row, ": ", row.buffered ? "a buffer" : to.type->name,
                             " cannot be interpolated; write in_steps, or connect a floating-point value");
    return {};
}

/// Checks that a silent sender is noticed, and that one that sends in time is not called silent.
constexpr Sentence check_age(const MachineView& m, const ConnectionRow& row, const Facet& from,
                             std::size_t writer) {
    if (row.buffered) return {};
    if (from.comes_every > Duration::zero() && row.max_age == Duration::zero())
        return of_connection(
            row, ": \"", row.from, "\" comes from outside every ", from.comes_every.count() / 1000,
            " us, and nothing notices when it falls silent; add stale_after(...), longer than that, with "
            "hold, substitute(...) or stop_machine");
    const ActivityRow& activity = m.activities[writer];
    const bool is_outside = from.comes_every > Duration::zero();
    // A periodic activity, real-time or not, writes in its own cycles: in the first one after a value came.
    const Duration period = activity.periodic() ? activity.period : Duration::zero();
    const Duration every = !is_outside                  ? period
                           : period <= Duration::zero() ? from.comes_every
                                                        : (from.comes_every + period - 1ns) / period * period;
    if (row.max_age == Duration::zero() || row.max_age > every) return {};
    if (is_outside)
        return of_connection(row, ": stale_after(", row.max_age.count() / 1000,
                             " us) is not longer than the ", every.count() / 1000, " us in which \"",
                             row.from, "\" comes, so that good values would be stale; lengthen it");
    return of_connection(row, ": stale_after(", row.max_age.count() / 1000,
                         " us) is not longer than the period of ", every.count() / 1000,
                         " us of its writer's activity \"", activity.name,
                         "\", so that good values would be stale; lengthen it");
}

constexpr Sentence check_policies(const MachineView& m, const ConnectionRow& row, const Facet& to,
                                  std::size_t writer, std::size_t reader) {
    if (row.buffered && row.capacity == 0)
        return of_connection(row, " holds no value; write buffer<n> with n of at least 1");
    if (row.buffered && row.capacity > most_buffered)
        return of_connection(row, " holds ", row.capacity, " values, more than the ", most_buffered,
                             " of a row; write a smaller buffer<n>");
    if (row.says_age && row.max_age <= Duration::zero())
        return of_connection(row, ": stale_after(", row.max_age.count() / 1000,
                             " us) is not above 0, so that no value would ever be stale; write the longest "
                             "age, or leave it out");
    if (row.buffered && (row.max_age != Duration::zero() || row.stale_answers != 0 || row.before_first.given))
        return of_connection(
            row, ": values in a buffer have no age and no initial value; remove the option from the row");
    if (Sentence fault = check_transition(m, row, to, writer, reader); !fault.empty()) return fault;
    if (Sentence fault = check_row_value(row, "substitute", row.substitute, to); !fault.empty()) return fault;
    if (Sentence fault = check_row_value(row, "initially", row.before_first, to); !fault.empty())
        return fault;
    if (row.stale_answers > 1)
        return of_connection(row, " has more than one of hold, substitute and stop_machine; keep one");
    if (row.when_stale == WhenStale::stop && row.max_age == Duration::zero())
        return of_connection(
            row, " says what to do with a stale value but not when it is stale; add stale_after(...)");
    if (to.grows_stale && row.max_age == Duration::zero())
        return of_connection(row, " has no maximum age, but \"", row.to,
                             "\" needs staleness to detect silence; add stale_after(...) and hold");
    if (to.needs_wake && !row.wakes_reader && writer != reader && !m.activities[reader].periodic())
        return of_connection(row, ": \"", row.to, "\" is looked at only when activity \"",
                             m.activities[reader].name,
                             "\" is woken, so that a new value could wait for ever; add "
                             "wakes");
    if (row.wakes_reader && m.activities[reader].periodic())
        return of_connection(row, " wakes activity \"", m.activities[reader].name,
                             "\", which is periodic; remove wakes");
    if (row.wakes_reader && writer == reader)
        return of_connection(row, " wakes its own activity \"", m.activities[reader].name,
                             "\"; remove wakes");
    if (row.delayed_step && writer != reader)
        return of_connection(row, ": delayed means one cycle of one activity, but this row crosses from \"",
                             m.activities[writer].name, "\" to \"", m.activities[reader].name,
                             "\"; remove delayed");
    return {};
}

/// Checks a row against the rows before it: an input has one writer at a time, and a port has a limited
/// number of buffers.
constexpr Sentence check_writers(const MachineView& m, const TableIndexView& r, std::size_t x) {
    const ConnectionRow& row = m.connections[x];
    const Link& link = r.connections[x];
    std::size_t rows_there = 0;
    for (std::size_t j = r.connections_into.first[link.to.component]; j != nowhere;
         j = r.connections_into.next[j]) {
        if (!(r.connections[j].to == link.to)) continue;
        if (r.connections[j].from == link.from)
            return of_connection(row, " appears twice in connections(...), rows ", j + 1, " and ", x + 1,
                                 "; remove one");
        if (!row.buffered && take_turns(m, r.connections[j].from.component, link.from.component)) continue;
        if (!row.buffered)
            return of_connection(row, ": \"", row.to, "\" is written by \"", m.connections[j].from,
                                 "\" already; an input has one writer: remove one row, or use a buffer");
        ++rows_there;
    }
    if (!row.buffered) return {};
    std::size_t rows_here = 0;
    for (std::size_t j = r.connections_from.first[link.from.component]; j != nowhere;
         j = r.connections_from.next[j])
        if (m.connections[j].buffered && r.connections[j].from == link.from) ++rows_here;
    if (rows_here >= max_buffer_rows || rows_there >= max_buffer_rows)
        return of_connection(row, " exceeds the ", max_buffer_rows,
                             " buffer rows that a port may have; merge some");
    return {};
}

/// Checks each connection; fills its ends.
constexpr Sentence check_connections(const MachineView& m, TableIndexView r) {
    r.connections_into.clear();
    r.connections_from.clear();
    for (std::size_t x = 0; x < m.connections.size(); ++x) {
        const ConnectionRow& row = m.connections[x];
        Link& link = r.connections[x];
        const FacetKind from_kind = row.buffered ? FacetKind::buffer_output : FacetKind::output;
        const FacetKind to_kind = row.buffered ? FacetKind::buffer_input : FacetKind::input;
        if (Sentence fault = resolve(m, r.by_name, row.from, from_kind, link.from); !fault.empty())
            return of_connection(row, ": ", fault);
        if (Sentence fault = resolve(m, r.by_name, row.to, to_kind, link.to); !fault.empty())
            return of_connection(row, ": ", fault);
        const Facet& to = facet_at(m, link.to);
        if (Sentence fault = check_direction(row, facet_at(m, link.from), to); !fault.empty()) return fault;
        if (Sentence fault = check_units(row, facet_at(m, link.from), to); !fault.empty()) return fault;
        if (Sentence fault =
                check_policies(m, row, to, r.activity[link.from.component], r.activity[link.to.component]);
            !fault.empty())
            return fault;
        if (Sentence fault = check_age(m, row, facet_at(m, link.from), r.activity[link.from.component]);
            !fault.empty())
            return fault;
        if (Sentence fault = check_writers(m, r, x); !fault.empty()) return fault;
        r.connections_into.add(x, link.to.component);
        r.connections_from.add(x, link.from.component);
    }
    for (std::size_t c = 0; c < m.components.size(); ++c)
        for (std::size_t f = 0; f < m.components[c].type->facets.size(); ++f) {
            const Facet& facet = m.components[c].type->facets[f];
            if (!facet.required || (facet.kind != FacetKind::input && facet.kind != FacetKind::buffer_input))
                continue;
            bool connected = false;
            for (std::size_t x = r.connections_into.first[c]; x != nowhere && !connected;
                 x = r.connections_into.next[x])
                connected = r.connections[x].to.facet == f;
            if (!connected)
                return of_component(m.components[c].name, ": its required input \"", facet.name,
                                    "\" is not connected; add ",
                                    facet.kind == FacetKind::input ? "data" : "buffer<n>", "(\"...\", \"",
                                    m.components[c].name, ".", facet.name, "\")");
        }
    return {};
}

/// Orders the components of each activity by data flow (thesis 3.2: the kernel's data-flow order). A delayed
/// row is reversed: its reader runs before its writer, and so always sees the last cycle's value.
class DataFlowOrder {
public:
    constexpr DataFlowOrder(const MachineView& m, const TableIndexView& r) noexcept : m_{m}, r_{r} {}

    /// `begin`: the index of the activity's first component in r.in_order.
    constexpr Sentence order(std::size_t activity, std::size_t begin) {
        activity_ = activity;
        members_.used = 0;
        for (const auto& name : m_.activities[activity].runs)
            static_cast<void>(members_.push(find_component(m_, r_.by_name, name)));
        for (const std::size_t c : members_) r_.waits_for[c] = 0;
        if (Sentence fault = check_own_outputs(); !fault.empty()) return fault;
        for (const std::size_t reader : members_)
            for (std::size_t row = first_row(reader); row != nowhere; row = next_row(row))
                ++r_.waits_for[after(row)];
        for (std::size_t placed = 0; placed < members_.size(); ++placed) {
            // The first component of the activity's row that is ready.
            std::size_t next = 0;
            while (next < members_.size() && (!waits(members_[next]) || r_.waits_for[members_[next]] != 0))
                ++next;
            if (next == members_.size()) return cycle();
            r_.position[members_[next]] = placed;
            r_.in_order[begin + placed] = members_[next];
            release_those_after(members_[next]);
        }
        return {};
    }

private:
    [[nodiscard]] constexpr bool waits(std::size_t component) const noexcept {
        return r_.position[component] == nowhere;
    }

    // A row between two components of the activity orders them.
    [[nodiscard]] constexpr std::size_t writer(std::size_t row) const noexcept {
        return r_.connections[row].from.component;
    }
    [[nodiscard]] constexpr std::size_t reader(std::size_t row) const noexcept {
        return r_.connections[row].to.component;
    }
    [[nodiscard]] constexpr std::size_t before(std::size_t row) const noexcept {
        return m_.connections[row].delayed_step ? reader(row) : writer(row);
    }
    [[nodiscard]] constexpr std::size_t after(std::size_t row) const noexcept {
        return m_.connections[row].delayed_step ? writer(row) : reader(row);
    }
    [[nodiscard]] constexpr bool orders(std::size_t row) const noexcept {
        return writer(row) != reader(row) && r_.activity[writer(row)] == activity_ &&
               r_.activity[reader(row)] == activity_;
    }
    /// Iterates over the rows that order the reader and another component.
    [[nodiscard]] constexpr std::size_t first_row(std::size_t reader) const noexcept {
        return ordering(r_.connections_into.first[reader], r_.connections_into);
    }
    [[nodiscard]] constexpr std::size_t next_row(std::size_t row) const noexcept {
        return ordering(r_.connections_into.next[row], r_.connections_into);
    }
    [[nodiscard]] constexpr std::size_t ordering(std::size_t row,
                                                 const RowsByComponent& rows) const noexcept {
        while (row != nowhere && !orders(row)) row = rows.next[row];
        return row;
    }

    constexpr void release_those_after(std::size_t component) const noexcept {
        for (const RowsByComponent* rows : {&r_.connections_into, &r_.connections_from})
            for (std::size_t row = rows->first[component]; row != nowhere; row = rows->next[row])
                if (orders(row) && before(row) == component) --r_.waits_for[after(row)];
    }

    [[nodiscard]] constexpr Sentence check_own_outputs() const {
        for (const std::size_t c : members_)
            for (std::size_t x = r_.connections_into.first[c]; x != nowhere; x = r_.connections_into.next[x])
                if (r_.connections[x].from.component == c && !m_.connections[x].delayed_step &&
                    !m_.connections[x].buffered)
                    return of_connection(
                        m_.connections[x],
                        ": a component's own output feeds its own input; add delayed, or keep "
                        "the value in the component");
        return {};
    }

    /// Returns the fault of a cycle: walks against the flow from a waiting member until it meets itself.
    /// Every row on the way is in the cycle.
    [[nodiscard]] constexpr Sentence cycle() const {
        std::size_t first = 0;
        while (!waits(members_[first])) ++first;
        std::size_t at = members_[first];
        // After as many steps as there are members the walk is inside a cycle, wherever it started.
        for (std::size_t steps = 0; steps < members_.size(); ++steps) at = before(row_into(at));
        const std::size_t met = at;
        std::size_t last = row_into(at);
        for (at = before(last); at != met; at = before(row_into(at)))
            if (row_into(at) > last) last = row_into(at);
        at = after(last);
        Sentence way{m_.components[at].name};
        do {
            at = before(row_into(at));
            way = Sentence{m_.components[at].name, " -> ", way};
        } while (at != after(last));
        return of_connection(m_.connections[last], " closes a data-flow cycle inside activity \"",
                             m_.activities[activity_].name, "\" (", way,
                             "); add delayed to the row whose reader may use the last cycle's value");
    }
    /// Returns a row by which the component waits for another waiting one.
    [[nodiscard]] constexpr std::size_t row_into(std::size_t component) const noexcept {
        for (const std::size_t reader : members_)
            for (std::size_t row = first_row(reader); row != nowhere; row = next_row(row))
                if (after(row) == component && waits(before(row))) return row;
        return nowhere;
    }

    const MachineView& m_;
    const TableIndexView& r_;
    std::size_t activity_ = nowhere;
    Bounded<std::size_t, ActivityRow::max_runs> members_{}; ///< in the order of the activity's row
};

constexpr Sentence order_components(const MachineView& m, const TableIndexView& r) {
    for (auto& each : r.position) each = nowhere;
    DataFlowOrder flow{m, r};
    std::size_t begin = 0;
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        if (Sentence fault = flow.order(a, begin); !fault.empty()) return fault;
        begin += m.activities[a].runs.size();
    }
    return {};
}

} // namespace tappet::checks

// Checks of components that run in turns (thesis 3.1.3: some need to be executed exclusively): each value has
// exactly one writer whichever chain runs, and a member that takes over starts from the current values.
#pragma once

#include "kernel/control/check_flow.hpp"

namespace tappet::control_detail {

template <class... Pieces>
constexpr Sentence of_exclusive(const ExclusiveRow& row, const Pieces&... fault) {
    return Sentence{"exclusive \"", row.by, "\": ", fault...};
}

/// Maximum number, for one row, of inputs that several members write in turns and calls that several members
/// answer (a hand-over links both again), and of inputs from other activities (a chain falls back when one
/// becomes stale).
inline constexpr std::size_t max_links = 16;
inline constexpr std::size_t max_calls = 8;
inline constexpr std::size_t max_watched = 16;

constexpr bool is_member(const ExclusiveRow& row, const MachineView& m, std::size_t component) noexcept {
    return chains_of(row, m.components[component].name) != 0;
}

/// Returns whether several rows write the same input in turns.
constexpr bool is_shared(const TableIndexView& r, std::size_t x) noexcept {
    const Link& link = r.connections[x];
    for (std::size_t j = r.connections_into.first[link.to.component]; j != nowhere;
         j = r.connections_into.next[j])
        if (j != x && r.connections[j].to == link.to) return true;
    return false;
}

/// Returns whether a row binds a call to a member, and another row binds it elsewhere.
constexpr bool is_answered_by_turns(const ExclusiveRow& row, const MachineView& m, const TableIndexView& r,
                                    std::size_t x) noexcept {
    if (m.reactions[x].kind != ReactionKind::uses || !is_member(row, m, r.reactions[x].to.component))
        return false;
    for (std::size_t j = 0; j < m.reactions.size(); ++j)
        if (j != x && m.reactions[j].kind == ReactionKind::uses && r.reactions[j].from == r.reactions[x].from)
            return true;
    return false;
}

constexpr Sentence check_switch(const ExclusiveRow& row, const MachineView& m,
                                const ComponentType* switch_type) {
    const std::size_t by = find_component(m, row.by);
    if (by == nowhere) return of_exclusive(row, unknown_component(m, row.by));
    if (m.components[by].type != switch_type)
        return of_exclusive(row, "\"", row.by, "\" cannot switch chains; make it a component<ChainSwitch>");
    if (row.too_many) return of_exclusive(row, too_many("chains", ExclusiveRow::max_chains));
    std::size_t fallbacks = 0;
    for (const ChainRow& each : row.chains) fallbacks += each.is_fallback ? 1 : 0;
    if (row.chains.size() < 2)
        return of_exclusive(row, "it has fewer than two chains to switch between; add one, or leave it out");
    if (fallbacks != 1 || !row.chains[0].is_fallback)
        return of_exclusive(row,
                            "it needs exactly one fallback(...), which runs first and when a chain fails; "
                            "begin with fallback(\"...\", ...), and write chain(...) for the others");
    return {};
}

constexpr Sentence check_member(const ControlView& c, const ExclusiveRow& row, const ChainRow& chain,
                                std::string_view name, const MachineView& m, const TableIndexView& r,
                                const Seats& seats) {
    const std::size_t component = find_component(m, name);
    if (component == nowhere) return unknown_component(m, name);
    const bool is_process = level_of(seats, component) == no_level && has_seat(seats, component);
    if (level_of(seats, component) == no_level && !is_process)
        return Sentence{"\"", name, "\" has no role in control(...); give it one first"};
    const std::size_t by = find_component(m, row.by);
    if (r.activity[component] != r.activity[by])
        return Sentence{"\"",
                        name,
                        "\" runs in activity \"",
                        m.activities[r.activity[component]].name,
                        "\", but \"",
                        row.by,
                        "\" in \"",
                        m.activities[r.activity[by]].name,
                        "\"; it can switch in its own activity only; run both in one activity"};
    if (r.position[component] < r.position[by])
        return Sentence{"\"", row.by, "\" runs after \"", name,
                        "\" and would switch in the middle of a step; name it first in runs(...)"};
    if (m.components[component].type->start == nullptr && !is_process)
        return Sentence{"\"", name, "\" of chain \"", chain.name,
                        "\" has no start(), so that it would continue from its last run; add one that writes "
                        "first values from its inputs: void start(const Cycle&) noexcept TAPPET_REALTIME"};
    for (const BehaviourRow& each : m.behaviours)
        if (same_text(each.component, name))
            return Sentence{"\"", name,
                            "\" has a behaviour, which cannot end within a step; give the behaviour to the "
                            "process component"};
    for (const ExclusiveRow& other : c.exclusives)
        if (&other != &row && chains_of(other, name) != 0)
            return Sentence{"\"", name, "\" is also in exclusive \"", other.by, "\"; keep it in one"};
    return {};
}

/// Checks an input that members write: each chain has exactly one writer.
constexpr Sentence check_one_writer(const ExclusiveRow& row, const MachineView& m, const TableIndexView& r,
                                    std::size_t x) {
    const Link& link = r.connections[x];
    for (std::size_t k = 0; k < row.chains.size(); ++k) {
        std::size_t writers = 0;
        for (std::size_t j = 0; j < m.connections.size(); ++j)
            if (r.connections[j].to == link.to &&
                (chains_of(row, m.components[r.connections[j].from.component].name) >> k & 1) != 0)
                ++writers;
        const unsigned reader = chains_of(row, m.components[link.to.component].name);
        const bool is_read = reader == 0 || (reader >> k & 1) != 0;
        if (writers != 1 && is_read)
            return of_exclusive(row, "while chain \"", row.chains[k].name, "\" runs, no component writes \"",
                                m.connections[x].to, "\"; add one that does to the chain");
    }
    return {};
}

/// Checks a call that members answer: each chain has exactly one answering member.
constexpr Sentence check_shared_calls(const ExclusiveRow& row, const MachineView& m,
                                      const TableIndexView& r) {
    std::size_t calls = 0;
    for (std::size_t x = 0; x < m.reactions.size(); ++x) {
        if (!is_answered_by_turns(row, m, r, x)) continue;
        unsigned answered = 0;
        bool is_first = true;
        for (std::size_t j = 0; j < m.reactions.size(); ++j) {
            if (m.reactions[j].kind != ReactionKind::uses || !(r.reactions[j].from == r.reactions[x].from))
                continue;
            answered |= chains_of(row, m.components[r.reactions[j].to.component].name);
            is_first = is_first && j >= x;
        }
        for (std::size_t k = 0; k < row.chains.size(); ++k)
            if ((answered >> k & 1) == 0)
                return of_exclusive(row, "while chain \"", row.chains[k].name,
                                    "\" runs, no component answers \"", m.reactions[x].event,
                                    "\"; add one that does to the chain, and a row uses(...) to it");
        calls += is_first ? 1 : 0;
    }
    if (calls > max_calls) return of_exclusive(row, too_many("calls answered by several chains", max_calls));
    return {};
}

constexpr bool same_value(const RowValue& a, const RowValue& b) noexcept {
    return a.given == b.given && a.number == b.number && a.constant == b.constant;
}

constexpr Sentence check_shared_inputs(const ExclusiveRow& row, const MachineView& m,
                                       const TableIndexView& r) {
    std::size_t links = 0, watched = 0;
    for (std::size_t x = 0; x < m.connections.size(); ++x) {
        const Link& link = r.connections[x];
        const ConnectionRow& own = m.connections[x];
        if (is_member(row, m, link.to.component) &&
            r.activity[link.from.component] != r.activity[link.to.component])
            ++watched;
        if (!is_member(row, m, link.from.component) || own.buffered || !is_shared(r, x)) continue;
        if (r.activity[link.from.component] != r.activity[link.to.component])
            return checks::of_connection(
                own, ": a value that several chains write can be read only in their activity \"",
                m.activities[r.activity[link.from.component]].name,
                "\"; connect a value derived from it there");
        if (Sentence fault = check_one_writer(row, m, r, x); !fault.empty()) return fault;
        bool is_first = true;
        for (std::size_t j = 0; j < x; ++j) {
            if (!(r.connections[j].to == link.to)) continue;
            is_first = false;
            const ConnectionRow& other = m.connections[j];
            if (other.max_age != own.max_age || other.when_stale != own.when_stale ||
                !same_value(other.substitute, own.substitute) ||
                !same_value(other.before_first, own.before_first) || other.delayed_step != own.delayed_step ||
                is_scaled(own) || is_scaled(other))
                return checks::of_connection(own, ": this row and \"", other.from,
                                             "\" write in different chains but have different options; give "
                                             "both rows the same options, and no scale");
        }
        links += is_first ? 1 : 0;
    }
    if (links > max_links) return of_exclusive(row, too_many("inputs written by several chains", max_links));
    if (watched > max_watched)
        return of_exclusive(row, too_many("inputs from other activities", max_watched));
    return {};
}

/// The tracked value must be what one of the Controller's own outputs would have been, in the same unit: rows
/// ensure that the Effector's unit is that of the input.
constexpr Sentence check_tracked_unit(const Seat& seat, const ControlView& c, const ComponentRow& own,
                                      std::size_t facet) {
    const Facet& tracked = own.type->facets[facet];
    if (tracked.unit.empty()) return {};
    const Facet* other = nullptr;
    for (const Facet& each : own.type->facets) {
        if (each.kind != FacetKind::output || each.type != tracked.type) continue;
        if (each.unit.empty() || each.unit == tracked.unit) return {};
        const checks::Unit a = checks::parse_unit(tracked.unit), b = checks::parse_unit(each.unit);
        if (checks::converts(a, b) && a.same(b)) return {};
        other = &each;
    }
    if (other == nullptr) return {};
    return of_level(c.levels[seat.level], "\"", own.name, ".", tracked.name, "\" tracks in ", tracked.unit,
                    ", and \"", own.name, ".", other->name, "\" writes in ", other->unit,
                    "; give both the unit of what is sent");
}

/// A Controller that takes over starts from the value that the Effector sent last. Estimators that take turns
/// estimate the same world: their values are no reason to start again.
constexpr Sentence check_tracking(const Seat& seat, const ControlView& c, const MachineView& m,
                                  const TableIndexView& r, const Seats& seats) {
    const ComponentRow& own = m.components[seat.component];
    bool takes_turns = false;
    for (const ExclusiveRow& row : c.exclusives) takes_turns |= chains_of(row, own.name) != 0;
    for (std::size_t x = r.connections_into.first[seat.component]; x != nowhere;
         x = r.connections_into.next[x])
        takes_turns |= is_shared(r, x) && !m.connections[x].buffered &&
                       seat_of(seats, r.connections[x].from.component).role != ControlRole::estimator;
    if (seat.tracked.empty())
        return takes_turns
                   ? of_level(c.levels[seat.level], "the Controller \"", own.name,
                              "\" or one of its writers runs in a chain, but it does not know what was sent "
                              "last, so that the axis would jump; connect an Effector's output to one of its "
                              "inputs, delayed, and name that input: controller(\"",
                              own.name, "\", tracks(\"...\"))")
                   : Sentence{};
    if (takes_turns && own.type->start == nullptr)
        return of_level(c.levels[seat.level], "the Controller \"", own.name,
                        "\" tracks what was sent but has no start(); add one that writes the first output "
                        "from it: void start(const Cycle&) noexcept TAPPET_REALTIME");
    const std::size_t facet = find_facet(own, seat.tracked);
    if (facet == nowhere || own.type->facets[facet].kind != FacetKind::input)
        return of_level(c.levels[seat.level], "\"", own.name, "\" has no input \"", seat.tracked,
                        "\" to track; name the one that receives what was sent");
    for (std::size_t x = r.connections_into.first[seat.component]; x != nowhere;
         x = r.connections_into.next[x]) {
        if (r.connections[x].to.facet != facet) continue;
        for (const Seat& each : seats)
            if (each.component == r.connections[x].from.component && each.role == ControlRole::effector)
                return check_tracked_unit(seat, c, own, facet);
    }
    return of_level(c.levels[seat.level], "\"", own.name, ".", seat.tracked,
                    "\" tracks a value that does not come from an Effector, which alone knows what was sent; "
                    "connect it to one");
}

constexpr Sentence check_turns(const ControlView& c, const MachineView& m, const TableIndexView& r,
                               const Seats& seats, const ComponentType* switch_type) {
    for (const ExclusiveRow& row : c.exclusives) {
        if (Sentence fault = check_switch(row, m, switch_type); !fault.empty()) return fault;
        for (std::size_t k = 0; k < row.chains.size(); ++k) {
            const ChainRow& chain = row.chains[k];
            if (chain.too_many)
                return of_exclusive(row, too_many("components in a chain", ChainRow::max_members));
            for (std::size_t j = 0; j < k; ++j)
                if (same_text(row.chains[j].name, chain.name))
                    return of_exclusive(row, "two chains are called \"", chain.name, "\"; rename one");
            for (const std::string_view name : chain.members)
                if (Sentence fault = check_member(c, row, chain, name, m, r, seats); !fault.empty())
                    return of_exclusive(row, fault);
        }
        if (Sentence fault = check_shared_inputs(row, m, r); !fault.empty()) return fault;
        if (Sentence fault = check_shared_calls(row, m, r); !fault.empty()) return fault;
    }
    for (const Seat& seat : seats)
        if (seat.role == ControlRole::controller)
            if (Sentence fault = check_tracking(seat, c, m, r, seats); !fault.empty()) return fault;
    for (const ComponentRow& each : m.components)
        if (each.type == switch_type) {
            bool is_named = false;
            for (const ExclusiveRow& row : c.exclusives) is_named |= same_text(row.by, each.name);
            if (!is_named)
                return Sentence{"component \"", each.name,
                                "\" switches chains, but no row says which; add exclusive(\"", each.name,
                                "\", fallback(...), chain(...)) to control(...)"};
        }
    return {};
}

} // namespace tappet::control_detail

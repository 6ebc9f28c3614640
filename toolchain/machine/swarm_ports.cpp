// Reads each port in place, without a request to its component.
#include "toolchain/machine/swarm_ports.hpp"

#include "kernel/base/number.hpp"

#include <cstring>

namespace tappet {

namespace {

/// Limit for a component with state to forget one not-a-number value.
constexpr Duration forgets_within = 3s;
constexpr std::uint64_t forgets_in = 100; // values
constexpr Duration looks_every = 1ms;

} // namespace

SwarmPorts::SwarmPorts(const AcceptedMachine& machine) : machine_{machine} {
    const auto rows = machine.table.components;
    for (std::size_t c = 0; c < rows.size(); ++c) {
        const auto facets = rows[c].type->facets;
        for (std::size_t f = 0; f < facets.size(); ++f) {
            const Facet& facet = facets[f];
            const bool is_input = facet.kind == FacetKind::input;
            if (!is_input && facet.kind != FacetKind::output) continue;
            if (facet.at_rest >= tappet::AtRest::says_false)
                at_rest_.push_back({{c, f}, facet.at_rest == tappet::AtRest::says_true});
            if (facet.type->kind == ValueKind::real)
                reals_.push_back({{c, f}, is_input, !is_input && rows[c].type->device_kind != nullptr});
        }
    }
}

void SwarmPorts::begin(MachineInstance& instance) {
    instance_ = &instance;
    next_ = {};
    for (Real& each : reals_) {
        each.none_since = never;
        for (std::size_t s = 0; s < machine_.table.extras->size(); ++s)
            for (std::size_t row = 0; !instance.observation().counted(s, row).what.empty(); ++row)
                each.is_judged |= instance.observation().counted(s, row).what == name_of(each.end).view();
    }
}

Sentence SwarmPorts::name_of(End end) const {
    return Sentence{machine_.table.components[end.component].name, ".", facet_at(machine_.table, end).name};
}

/// A stopped component's output must have the value that its interface states for standstill.
Sentence SwarmPorts::misleads(const AtRest& each) const {
    if (instance_->life().state_of(each.end.component) != ComponentState::stopped) return {};
    const PortPlaces places =
        facet_at(machine_.table, each.end).port->places(instance_->place_of(each.end), false);
    bool says = false;
    std::memcpy(&says, places.value, sizeof says);
    if (*places.forced || says == each.says) return {};
    return Sentence{"\"", name_of(each.end), "\" says ", says ? "true" : "false",
                    " though its component is stopped"};
}

/// Any other port must return to a number, whatever it received.
Sentence SwarmPorts::is_none(Real& each, Time now) const {
    const Facet& facet = facet_at(machine_.table, each.end);
    const PortPlaces places = facet.port->places(instance_->place_of(each.end), each.is_input);
    double value = 0;
    if (float narrow = 0; facet.type->size == sizeof narrow) {
        std::memcpy(&narrow, places.value, sizeof narrow);
        value = static_cast<double>(narrow);
    } else {
        std::memcpy(&value, places.value, sizeof value);
    }
    const bool is_number_now = is_number(value);
    if (!is_number_now && each.is_judged)
        return Sentence{"\"", name_of(each.end), "\" is not a number, though limits or a driver check it"};
    const bool runs = instance_->life().state_of(each.end.component) == ComponentState::running;
    if (is_number_now || !runs) {
        each.none_since = never;
    } else if (each.none_since == never) {
        each.none_since = now;
        each.written_then = *places.writes;
    }
    if (each.none_since == never || now - each.none_since < forgets_within ||
        *places.writes - each.written_then < forgets_in)
        return {};
    return Sentence{"\"", name_of(each.end), "\" does not become a number again"};
}

Sentence SwarmPorts::broken(Time now) {
    if (instance_ == nullptr || now < next_) return {};
    next_ = now + looks_every;
    for (const AtRest& each : at_rest_)
        if (Sentence why = misleads(each); !why.empty()) return why;
    for (Real& each : reals_)
        if (Sentence why = is_none(each, now); !why.empty()) return why;
    return {};
}

} // namespace tappet

// The outputs of a machine, found in its table and its maps, and the rules that hold for all of them.
#include "toolchain/machine/swarm_wires.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tappet {

SwarmWires::SwarmWires(const AcceptedMachine& machine, SimulatedDevices& devices, const Struck& struck,
                       const AllLeftBehind* left)
    : machine_{machine}, devices_{devices}, struck_{struck}, left_{left} {}

void SwarmWires::listen() {
    const auto rows = machine_.table.components;
    for (std::size_t c = 0; c < rows.size(); ++c) {
        if (!SimulatedDevices::is_judged(rows[c])) continue;
        for (WireOutput& each : devices_.outputs(rows[c].device)) add(c, std::move(each));
    }
    add_axes();
    find_together();
    devices_.look_at_frames([this](std::string_view device, const can::Frame& frame) {
        for (Axis& axis : axes_) hear_axis(axis, device, frame);
    });
}

void SwarmWires::begin(MachineInstance& instance) {
    instance_ = &instance;
    for (Axis& each : axes_) {
        each.rests_at = {};
        each.rests_since = each.astray_since = never;
        if (each.stands_below < 0.0)
            each.stands_below = *static_cast<const double*>(instance.facet(each.standing));
    }
    for (Output& each : outputs_) {
        each.before = each.left = {};
        each.since = each.wanted_since = never;
        each.told_looked = {};
        each.wanted = std::numeric_limits<double>::quiet_NaN();
        each.excused = {};
    }
}

void SwarmWires::excuse(std::size_t driver, Time until) {
    for (Output& each : outputs_)
        if (each.driver == driver) {
            each.excused = std::max(each.excused, until);
            each.is_meddled = true;
        }
}

/// Adds an output with all components that write to its facets, by any row of the table.
void SwarmWires::add(std::size_t c, WireOutput at_wire) {
    const MachineView& table = machine_.table;
    Output output{std::move(at_wire), c};
    const std::string name = output.name;
    const std::string driver{table.components[output.driver].name};
    const auto facets = table.components[output.driver].type->facets;
    const auto switches = [&](std::string_view facet) {
        return output.operations.empty()
                   ? facet == name
                   : std::ranges::find(output.operations, facet) != output.operations.end();
    };
    output.name = driver + "." + name;
    for (std::size_t f = 0; f < facets.size(); ++f)
        if (switches(facets[f].name)) output.facets.push_back({output.driver, f});
    const auto is_meant = [&](End end) {
        return std::ranges::find(output.facets, end) != output.facets.end();
    };
    const auto write = [&](std::size_t component) {
        if (component != output.driver &&
            std::ranges::find(output.writers, component) == output.writers.end())
            output.writers.push_back(component);
    };
    Duration oldest{};
    for (std::size_t x = 0; x < table.connections.size(); ++x) {
        const Link& link = machine_.index.connections[x];
        if (!is_meant(link.to)) continue;
        write(link.from.component);
        oldest = std::max(oldest, table.connections[x].max_age);
    }
    for (std::size_t r = 0; r < table.reactions.size(); ++r)
        if (is_meant(machine_.index.reactions[r].to)) write(machine_.index.reactions[r].from.component);
    for (const BehaviourRow& row : table.behaviours)
        for (const std::string_view operation : row.slot.operations)
            if (operation.starts_with(driver + ".") && switches(operation.substr(driver.size() + 1)))
                write(find_component(table, row.component));
    output.settles += usual_settling + oldest;
    output.grows_stale = oldest > Duration{};
    outputs_.push_back(std::move(output));
}

bool SwarmWires::drives(const Output& output) const {
    return std::ranges::any_of(output.writers, [this](std::size_t c) {
        const ComponentState state = instance_->life().state_of(c);
        return state == ComponentState::running || state == ComponentState::starting ||
               state == ComponentState::stopping;
    });
}

bool SwarmWires::is_forced(const Output& output) const {
    return std::ranges::any_of(output.facets, [this](End end) {
        const Facet& facet = facet_at(machine_.table, end);
        return facet.kind == FacetKind::input && facet.port != nullptr &&
               *facet.port->places(instance_->place_of(end), true).forced;
    });
}

Sentence SwarmWires::told(const Output& output, std::uint64_t value) const {
    Sentence text{"output \"", output.name, "\" is ", value, " at the wire"};
    if (output.safe) text.add(" (safe: ").add(*output.safe).add(")");
    return text;
}

/// A stopped component leaves what its stop() wrote, or the safe value, and moves no output any more.
Sentence SwarmWires::broken(Output& output, Time now) const {
    if (output.writers.empty()) return {};
    const auto value = output.read(now);
    if (Sentence why = told_otherwise(output, value, now); !why.empty()) return why;
    if (!value) return {};
    if (now >= output.excused && output.safe && *value == *output.safe) output.is_meddled = false;
    if (drives(output)) {
        output.before = value;
        output.left = {};
        output.since = never;
        return {};
    }
    if (output.since == never) output.since = now;
    if (is_forced(output)) output.excused = std::max(output.excused, now + output.settles);
    const bool is_driven = instance_->life().state_of(output.driver) == ComponentState::running;
    if (now < output.excused || !is_driven ||
        struck_.whole_for(output.driver, now) < output.settles + output.recovers) {
        output.before = output.left = {};
        output.since = now;
        return {};
    }
    if (now - output.since < output.settles) return {};
    if (output.is_meddled && !output.left) output.left = value; // as a direct request to the driver left it
    const bool is_safe = output.safe && *value == *output.safe;
    if (!output.left) {
        output.left = value;
        const auto known = left_ == nullptr ? AllLeftBehind::const_iterator{} : left_->find(output.name);
        if (left_ != nullptr && known != left_->end() && !known->second.holds) {
            if (!is_safe && std::ranges::find(known->second.values, *value) == known->second.values.end())
                return told(output, *value)
                    .add(", though no component that drives it runs; its stop leaves another value");
        } else if (!is_safe && output.is_switch && output.before && *output.before != *value) {
            return told(output, *value)
                .add(", though no component that drives it runs: a stopped component switched it");
        }
    } else if (*output.left != *value) {
        if (!is_safe)
            return told(output, *value)
                .add(", though no component that drives it runs: it was ")
                .add(*output.left)
                .add(" when the last of them stopped");
        output.left = value;
    }
    return {};
}

Sentence SwarmWires::broken(Time now) {
    if (!heard_.empty()) return heard_;
    if (Sentence why = devices_.broken(); !why.empty()) return why;
    if (instance_ == nullptr) return {};
    now_ = now;
    for (Output& each : outputs_)
        if (Sentence why = broken(each, now); !why.empty()) {
            why.add(" (");
            for (const std::size_t c : each.writers)
                why.add(c == each.writers.front() ? "" : ", ").add(machine_.table.components[c].name);
            return why.add(")");
        }
    return {};
}

Sentence SwarmWires::broken_at_rest(bool by_guardian) const {
    for (const Output& each : outputs_) {
        // The receiver detects by itself when its device could not be reached.
        if (!each.safe || struck_.whole_for(each.driver, never) < Duration{}) continue;
        if (const auto value = each.read(now_); value && *value != *each.safe)
            return told(each, *value)
                .add(by_guardian ? ", though its guardian made it safe"
                                 : ", though the machine has stopped and reports every device as reached");
    }
    return {};
}

std::vector<std::vector<std::size_t>> SwarmWires::all_writers() const {
    std::vector<std::vector<std::size_t>> all;
    for (const Output& each : outputs_)
        if (!each.writers.empty() && std::ranges::find(all, each.writers) == all.end())
            all.push_back(each.writers);
    return all;
}

Duration SwarmWires::settles(const std::vector<std::size_t>& writers) const {
    Duration longest{};
    for (const Output& each : outputs_)
        if (each.writers == writers) longest = std::max(longest, each.settles);
    return longest;
}

void SwarmWires::note_left(const std::vector<std::size_t>& writers, AllLeftBehind& left) const {
    for (const Output& each : outputs_) {
        const auto value = each.read(now_);
        if (each.writers != writers || !value || drives(each) || !each.left) continue;
        LeftBehind& known = left[each.name];
        if (each.safe && *value == *each.safe) continue;
        known.holds |= !each.safe || (each.before && *each.before == *value);
        known.values.push_back(*value);
    }
}

} // namespace tappet

// A value at a driver's input must go out to the wire, or else the nearest value that the wire can express.
#include "toolchain/machine/swarm_wires.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tappet {

namespace {

constexpr Duration looks_every = 5ms;
constexpr Duration looks_within = 2s; // for the restart of a bus that was off
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// True: a force hid that the writer stopped; the value is obsolete, its frame may be safe by silence.
bool is_abandoned(const Facet& input, const void* place) {
    return input.type == type_id<double> ? static_cast<const Input<double>*>(place)->is_abandoned()
           : input.type == type_id<std::int64_t>
               ? static_cast<const Input<std::int64_t>*>(place)->is_abandoned()
               : false;
}

} // namespace

/// Groups outputs that go out in one frame or request; excludes groups in which a row allows staleness.
void SwarmWires::find_together() {
    for (Output& each : outputs_) {
        each.together.clear();
        for (std::size_t o = 0; o < outputs_.size(); ++o)
            if (outputs_[o].driver == each.driver && outputs_[o].goes_in == each.goes_in)
                each.together.push_back(o);
        if (std::ranges::any_of(each.together, [this](std::size_t o) {
                return outputs_[o].grows_stale || outputs_[o].facets.empty();
            }))
            each.physical = {};
    }
}

/// Returns the value at the output's driver input; none: no value yet.
double SwarmWires::said(const Output& output) const {
    const Facet& facet = facet_at(machine_.table, output.facets.front());
    const void* const input = instance_->place_of(output.facets.front());
    const PortPlaces places = facet.port->places(input, true);
    if (!*places.forced && (*places.writes == 0 || is_abandoned(facet, input))) return none;
    const void* const value = *places.forced ? places.forced_value : places.value;
    if (facet.type->kind == ValueKind::real) {
        double number = 0;
        std::memcpy(&number, value, sizeof number);
        return number;
    }
    std::int64_t whole = 0;
    std::memcpy(&whole, value, sizeof whole);
    return static_cast<double>(whole);
}

Sentence SwarmWires::told_otherwise(Output& output, const std::optional<std::uint64_t>& value,
                                    Time now) const {
    if (!output.physical || now < output.told_looked + looks_every) return {};
    output.told_looked = now;
    double wanted = said(output);
    for (const std::size_t o : output.together)
        if (!std::isfinite(said(outputs_[o]))) wanted = none;
    const Duration recovers = output.settles + (value ? output.recovers : looks_within);
    const ComponentRow& driver = machine_.table.components[output.driver];
    const bool is_whole = instance_->life().state_of(output.driver) == ComponentState::running &&
                          !devices_.is_off(driver.device) && now >= output.excused &&
                          struck_.whole_for(output.driver, now) >= recovers;
    if (!is_whole || wanted != output.wanted) {
        output.wanted = wanted;
        output.wanted_since = now;
        return {};
    }
    if (now - output.wanted_since < (value ? output.settles : recovers)) return {};
    const WireNumbers& numbers = output.numbers;
    const double nearest = std::clamp(wanted, numbers.least, numbers.most);
    Sentence text{"output \"", output.name, "\" "};
    if (!value) return text.add("is no longer sent, though its driver runs");
    const bool is_safe = output.safe && *value == *output.safe;
    if (is_safe ||
        std::abs(output.physical(*value) - nearest) <= std::max(numbers.step, 1e-6 * std::abs(nearest)))
        return {};
    return told(output, *value).add(", but its driver's input is ").add(std::int64_t{std::llround(nearest)});
}

} // namespace tappet

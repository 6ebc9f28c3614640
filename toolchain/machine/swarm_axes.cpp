// The drives behind a machine's buses, and the rules that hold for all of them.
#include "toolchain/machine/swarm_wires.hpp"

#include <cmath>

namespace tappet {

/// Finds the axes by their facets: position and drive status come from signals of a bus, and the target goes
/// there.
void SwarmWires::add_axes() {
    const MachineView& table = machine_.table;
    const auto has = [](const ComponentType& type, std::string_view name, FacetKind kind) {
        for (std::size_t f = 0; f < type.facets.size(); ++f)
            if (type.facets[f].name == name && type.facets[f].kind == kind) return f;
        return nowhere;
    };
    for (std::size_t c = 0; c < table.components.size(); ++c) {
        const ComponentType& type = *table.components[c].type;
        const std::size_t state = has(type, "state", FacetKind::output),
                          standing = has(type, "standing", FacetKind::property);
        if (state == nowhere || standing == nowhere || has(type, "move_to", FacetKind::command) == nowhere)
            continue;
        Axis axis;
        axis.name = table.components[c].name;
        axis.state = {c, state};
        axis.standing = {c, standing};
        const std::array wires{std::pair{has(type, "position", FacetKind::input), &axis.place},
                               std::pair{has(type, "statusword", FacetKind::input), &axis.word},
                               std::pair{has(type, "mode_display", FacetKind::input), &axis.mode},
                               std::pair{has(type, "controlword", FacetKind::output), &axis.control},
                               std::pair{has(type, "target_position", FacetKind::output), &axis.target}};
        for (std::size_t x = 0; x < table.connections.size(); ++x) {
            const Link& link = machine_.index.connections[x];
            for (const auto& [facet, wire] : wires) {
                const bool is_sent = link.from == End{c, facet};
                const End driver = is_sent ? link.to : link.from;
                const ComponentRow& row = table.components[driver.component];
                if ((!is_sent && link.to != End{c, facet}) || !tappet::drives(row, "can")) continue;
                axis.device = row.device;
                axis.driver = driver.component;
                *wire = wire_of(*static_cast<const can::Identifiers*>(row.type->device_map),
                                facet_at(table, driver).name);
            }
        }
        if (std::ranges::all_of(wires, [](const auto& each) { return each.second->signal != nullptr; }))
            axes_.push_back(axis);
    }
}

SwarmWires::Axis::Wire SwarmWires::wire_of(const can::Identifiers& map, std::string_view facet) {
    for (const can::FrameRow& row : map.frames)
        for (const can::Signal& signal : map.signals.subspan(row.first, row.values))
            if (facet == std::string{row.name} + "." + std::string{signal.name})
                return {row.identifier, &signal};
    return {};
}

std::string_view SwarmWires::state_of(const Axis& axis) const {
    const Facet& facet = facet_at(machine_.table, axis.state);
    const std::byte* value =
        static_cast<const std::byte*>(facet.port->places(instance_->place_of(axis.state), false).value);
    std::size_t number = 0;
    std::memcpy(&number, value, facet.type->size);
    return number < facet.type->names.size() ? std::string_view{facet.type->names[number]}
                                             : std::string_view{};
}

/// An axis is home once its drive confirms this homing: the previous homing's bits must have cleared.
void SwarmWires::hear_homing(Axis& axis, std::string_view device, const can::Frame& frame) {
    constexpr std::uint64_t ended = 0x3000; // attained, or failed
    const std::string_view state = state_of(axis);
    const bool is_whole = !can::faulted(devices_.controller(device).state()) &&
                          struck_.whole_for(axis.driver, frame.stamp) >= Duration{} &&
                          frame.stamp >= axis.excused;
    if (state == "Standstill" && std::exchange(axis.goes_home, false) && !axis.goes_anew)
        heard_ = Sentence{"axis \"", axis.name, "\" is home, but its drive reported the previous homing"};
    axis.goes_anew = state == "Homing" &&
                     (axis.goes_anew || !is_whole ||
                      (axis.shows_homing && (can::extract(frame.data, *axis.word.signal) & ended) == 0));
    axis.goes_home = state == "Homing";
}

constexpr unsigned longest_lie = 5; ///< of a garbled wire, in frames

/// An enabled drive whose axis is in no motion stays in place. One that follows positions gets no target far
/// from the previous one, because it would move there at full speed. A drive that moves by itself must not
/// follow positions, and an error must remove power.
void SwarmWires::hear_axis(Axis& axis, std::string_view device, const can::Frame& frame) {
    constexpr std::uint64_t enabled_bits = 0x6F, enabled = 0x27; // of CiA 402's words
    constexpr std::uint64_t told_bits = 0x8F, told = 0x0F;
    constexpr std::uint64_t cyclic_position = 8, homing = 6;
    constexpr double far = 1000; // times the standstill threshold
    if (device != axis.device || instance_ == nullptr) return;
    const can::Identifier identifier{frame.id, frame.extended};
    if (identifier == axis.word.frame)
        axis.is_enabled = (can::extract(frame.data, *axis.word.signal) & enabled_bits) == enabled;
    if (identifier == axis.mode.frame) {
        const bool says_so =
            axis.is_enabled && can::extract(frame.data, *axis.mode.signal) == cyclic_position;
        axis.follows = says_so ? axis.follows + 1 : 0;
    }
    if (identifier == axis.mode.frame)
        axis.shows_homing = can::extract(frame.data, *axis.mode.signal) == homing;
    if (identifier == axis.word.frame) hear_homing(axis, device, frame);
    if (identifier == axis.control.frame)
        axis.is_told = (can::extract(frame.data, *axis.control.signal) & told_bits) == told;
    const bool follows = axis.is_told && axis.follows > longest_lie && frame.stamp >= axis.excused;
    if (!follows) axis.sent_to = {};
    if (identifier == axis.target.frame && follows) {
        const double place =
            can::to_physical(*axis.target.signal, can::extract(frame.data, *axis.target.signal));
        if (axis.sent_to && std::abs(place - *axis.sent_to) > far * axis.stands_below)
            heard_ = Sentence{"axis \"",
                              axis.name,
                              "\" follows positions, but its target jumps from ",
                              std::int64_t{std::llround(*axis.sent_to)},
                              " to ",
                              std::int64_t{std::llround(place)},
                              " at once"};
        axis.sent_to = place;
    }
    if (identifier != axis.place.frame) return;
    judge_place(axis, device, frame);
}

void SwarmWires::judge_place(Axis& axis, std::string_view device, const can::Frame& frame) {
    constexpr Duration comes_to_rest = 300ms, changes_mode = 2s;
    const std::string_view state = state_of(axis);
    // A drive that the machine cannot reach is left to its own time-out.
    const bool is_reached = !can::faulted(devices_.controller(device).state()) &&
                            struck_.whole_for(axis.driver, frame.stamp) >= Duration{};
    if (!is_reached || (state != "Disabled" && state != "Standstill"))
        axis.rests_since = never;
    else if (axis.rests_since == never)
        axis.rests_since = frame.stamp;
    const bool is_astray = state == "ErrorStop" || (state == "DiscreteMotion" && axis.follows > longest_lie);
    if (!is_reached || !axis.is_told || !is_astray || frame.stamp < axis.excused)
        axis.astray_since = never;
    else if (axis.astray_since == never)
        axis.astray_since = frame.stamp;
    else if (frame.stamp - axis.astray_since > changes_mode)
        heard_ = Sentence{"axis \"",
                          axis.name,
                          "\" is in \"",
                          state,
                          "\", and its drive ",
                          state == "ErrorStop" ? "has the order to enable" : "follows positions"};
    if (!axis.is_enabled || frame.stamp < axis.excused || axis.rests_since == never ||
        frame.stamp - axis.rests_since < comes_to_rest) {
        axis.rests_at = {};
        return;
    }
    const double place = can::to_physical(*axis.place.signal, can::extract(frame.data, *axis.place.signal));
    if (!axis.rests_at) axis.rests_at = place;
    const bool is_there =
        std::abs(place - *axis.rests_at) <= axis.stands_below + 3 * std::abs(axis.place.signal->factor);
    axis.elsewhere = is_there ? 0 : axis.elsewhere + 1;
    if (axis.elsewhere > longest_lie)
        heard_ = Sentence{"axis \"", axis.name, "\" moves unasked: it is in \"", state,
                          "\", and its drive is enabled"};
}

void SwarmWires::excuse_axes(Time until) {
    for (Axis& each : axes_) each.excused = std::max(each.excused, until);
}

} // namespace tappet

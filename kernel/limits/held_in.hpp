// A device's output that may be on in some states of a state machine only: a row of the machine table.
//     held_in("io.valve", "filler", "filling", "topping_up")
// In all other states, and while the component "filler" does not run, the output has its safe value: its
// driver passes everything that is asked for through one gate.
#pragma once

#include "kernel/limits/held_in_check.hpp"
#include "kernel/machine/instance/instance.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

/// The row. Several rows for one output must all allow it.
struct HeldIn final : ExtraSection {
    std::string_view output{};  ///< "component.output" of a driver: a line, a signal, a register
    std::string_view machine{}; ///< the component whose state machine has the states
    Bounded<std::string_view, StateGate::most_states> states{};

    constexpr HeldIn(std::string_view an_output, std::string_view a_machine,
                     const Bounded<std::string_view, StateGate::most_states>& some)
        : output{an_output}, machine{a_machine}, states{some} {}

    [[nodiscard]] constexpr Sentence check(const MachineView& m, const TableIndexView& r) const override;
    [[nodiscard]] constexpr std::size_t bytes(const MachineView&) const override;
    void connect(MachineInstance& machine, std::size_t number, std::span<std::byte> memory) const override;
    [[nodiscard]] Sentence describe_stop(std::size_t) const override { return {}; }
    [[nodiscard]] SectionCount counted(std::span<const std::byte> memory,
                                       std::size_t row) const noexcept override;
};

/// Lets an output be on, which means that its value is not the safe value of its driver's map, in these
/// states, and in the states inside them, of the state machine that drives the component `machine`. An order
/// that stands outside of them for longer than 100 ms, and than four periods of the slowest activity on its
/// way, is counted and told.
template <class... States>
constexpr HeldIn held_in(std::string_view output, std::string_view machine, const States&... states) {
    static_assert(sizeof...(States) != 0, "held_in(output, machine, states..) without a state lets the "
                                          "output never be on; name the states in which it may be on");
    static_assert(sizeof...(States) <= StateGate::most_states,
                  "held_in(..) takes at most 16 states; name a state around them");
    return {output, machine, {{std::string_view{states}...}, sizeof...(States)}};
}

namespace held_detail {

/// In the machine's memory.
struct Placed {
    const os::Clock* clock = nullptr;
    StateGate held{};
};

/// Returns the number of the device's output that a name stands for, or nowhere: "valve" is the input of that
/// name, or the operations "valve.set" and "valve.clear".
constexpr std::size_t output_of(const ComponentType& type, std::string_view name) noexcept {
    for (const Facet& each : type.facets) {
        if (each.device_output == 0 || !each.name.starts_with(name)) continue;
        const std::string_view rest = each.name.substr(name.size());
        if (rest.empty() || (each.kind == FacetKind::operation && rest == ".set"))
            return each.device_output - std::size_t{1};
    }
    return nowhere;
}

/// Returns the row of the behaviour that drives a component and is not loaded; null: none.
constexpr const BehaviourRow* behaviour_of(const MachineView& m, std::string_view component) noexcept {
    for (const BehaviourRow& row : m.behaviours)
        if (same_text(row.component, component) && !row.is_slot()) return &row;
    return nullptr;
}

constexpr Sentence check_output(const MachineView& m, const HeldIn& row) {
    const std::size_t dot = find_character(row.output, '.');
    if (dot == std::string_view::npos)
        return Sentence{"it is not of the form \"component.output\"; name both"};
    const std::string_view name = row.output.substr(dot + 1);
    const std::size_t c = find_component(m, row.output.substr(0, dot));
    if (c == nowhere) return unknown_component(m, row.output.substr(0, dot));
    const ComponentType& type = *m.components[c].type;
    if (output_of(type, name) != nowhere) return {};
    for (const ConnectionRow& each : m.connections)
        if (same_text(each.from, row.output))
            return Sentence{"it is a port, which others may write past; name the row of the driver that it "
                            "drives, such as \"",
                            each.to, "\""};
    if (find_facet(m.components[c], name) != nowhere)
        return Sentence{
            "it has no safe value that could be sent at any time; name an output line, or a signal "
            "or register that states .safe(..) in a row that is sent cyclically"};
    Nearest nearest{name};
    for (const Facet& each : type.facets)
        if (each.device_output != 0)
            nearest.consider(each.kind == FacetKind::operation ? each.name.substr(0, each.name.rfind('.'))
                                                               : each.name);
    Sentence text{"component \"", m.components[c].name, "\" has no output \"", name, "\""};
    detail::add_suggestion(text, nearest, "name a row of a driver's map that states a safe value");
    return text;
}

constexpr Sentence check_states(const MachineView& m, const HeldIn& row) {
    if (find_component(m, row.machine) == nowhere) return unknown_component(m, row.machine);
    const BehaviourRow* const driven = behaviour_of(m, row.machine);
    if (driven == nullptr)
        return Sentence{"no behaviour of the table drives component \"", row.machine,
                        "\", and the states of a loaded one are not known; name a component of "
                        "behaviours(..) without a slot"};
    for (const std::string_view state : row.states) {
        Nearest nearest{state};
        bool found = false;
        for (const BehaviourType& type : driven->unit().types)
            for (const StateRow& each : type.machine.states) {
                found |= same_text(each.name, state);
                nearest.consider(each.name);
            }
        if (found) continue;
        Sentence text{"the behaviour of \"", row.machine, "\" has no state \"", state, "\""};
        detail::add_suggestion(text, nearest, "name one of its states");
        return text;
    }
    return {};
}

} // namespace held_detail

constexpr std::size_t HeldIn::bytes(const MachineView&) const { return sizeof(held_detail::Placed); }
constexpr Sentence HeldIn::check(const MachineView& m, const TableIndexView& index) const {
    Sentence fault = held_detail::check_output(m, *this);
    if (fault.empty()) fault = held_detail::check_states(m, *this);
    if (fault.empty()) {
        const std::size_t dot = output.find('.');
        const std::size_t driver = find_component(m, output.substr(0, dot));
        fault = held_detail::check_programs(
            m, index, *held_detail::behaviour_of(m, machine), {states.data(), states.size()}, driver,
            held_detail::output_of(*m.components[driver].type, output.substr(dot + 1)));
    }
    return fault.empty() ? fault : Sentence{"held_in \"", output, "\": ", fault};
}

} // namespace tappet

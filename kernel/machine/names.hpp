// Names in a table, resolved: "component.facet" becomes two indices, or a sentence that says what is wrong and what
// was probably meant.
#pragma once

#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"
#include "kernel/machine/machine.hpp"

namespace tappet {

inline constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

/// One end of a row.
struct End {
    std::size_t component = nowhere;
    std::size_t facet = nowhere;
    constexpr bool operator==(const End&) const = default;
};

constexpr std::size_t find_component(const MachineView& m, std::string_view name) noexcept {
    for (std::size_t i = 0; i < m.components.size(); ++i)
        if (m.components[i].name == name) return i;
    return nowhere;
}

constexpr std::size_t find_activity(const MachineView& m, std::string_view name) noexcept {
    for (std::size_t i = 0; i < m.activities.size(); ++i)
        if (m.activities[i].name == name) return i;
    return nowhere;
}

constexpr std::size_t find_facet(const ComponentRow& row, std::string_view name) noexcept {
    for (std::size_t i = 0; i < row.type->facets.size(); ++i)
        if (row.type->facets[i].name == name) return i;
    return nowhere;
}

constexpr const Facet& facet_at(const MachineView& m, End end) noexcept { return m.components[end.component].type->facets[end.facet]; }

/// The activity that runs a component, or nowhere.
constexpr std::size_t activity_of(const MachineView& m, std::string_view component) noexcept {
    for (std::size_t i = 0; i < m.activities.size(); ++i)
        for (const auto& name : m.activities[i].runs)
            if (name == component) return i;
    return nowhere;
}

namespace detail {

constexpr void add_suggestion(Sentence& text, const Nearest& nearest, std::string_view otherwise) {
    if (nearest.best().empty()) text.add("; ").add(otherwise);
    else text.add("; did you mean \"").add(nearest.best()).add("\"?");
}

} // namespace detail

constexpr Sentence unknown_component(const MachineView& m, std::string_view name) {
    Nearest nearest{name};
    for (const auto& row : m.components) nearest.consider(row.name);
    Sentence text{"there is no component \"", name, "\""};
    detail::add_suggestion(text, nearest, "add it to components(...)");
    return text;
}

/// Finds "component.facet" where the facet is one of the two kinds; `found` is set and the answer empty, or the answer
/// is the fault and its cure.
constexpr Sentence resolve(const MachineView& m, std::string_view path, FacetKind wanted, End& found) {
    const std::size_t dot = path.find('.');
    if (dot == std::string_view::npos)
        return Sentence{"\"", path, "\" is not of the form \"component.", wanted == FacetKind::event ? "event" : wanted == FacetKind::operation ? "operation" : "port", "\"; name both"};
    const std::string_view component_name = path.substr(0, dot);
    const std::string_view facet_name = path.substr(dot + 1);
    const std::size_t component = find_component(m, component_name);
    if (component == nowhere) return unknown_component(m, component_name);
    const ComponentRow& row = m.components[component];
    const std::size_t facet = find_facet(row, facet_name);
    if (facet == nowhere) {
        Nearest nearest{facet_name};
        for (const auto& each : row.type->facets)
            if (each.kind == wanted) nearest.consider(each.name);
        Sentence text{"component \"", component_name, "\" has no ", to_text(wanted).substr(to_text(wanted).find(' ') + 1), " \"", facet_name, "\""};
        detail::add_suggestion(text, nearest, "add it to the component's interface");
        return text;
    }
    found = {component, facet};
    return {};
}

} // namespace tappet

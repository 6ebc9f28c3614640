// Resolves names in a table: "component.facet" becomes two indices, or a sentence that states the fault and
// the probable spelling.
#pragma once

#include "kernel/base/compare.hpp"
#include "kernel/base/nearest.hpp"
#include "kernel/base/text.hpp"
#include "kernel/machine/table/machine.hpp"

#include <algorithm>
#include <span>

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
        if (same_text(m.components[i].name, name)) return i;
    return nowhere;
}

/// Whether a path is "component.facet".
constexpr bool is_named(std::string_view path, std::string_view component, std::string_view facet) noexcept {
    return path.size() == component.size() + 1 + facet.size() && path.starts_with(component) &&
           path[component.size()] == '.' && path.ends_with(facet);
}

/// Lists the components in the order of their names, rows of one name in the order of the table.
constexpr void sort_by_name(const MachineView& m, std::span<std::size_t> by_name) noexcept {
    for (std::size_t i = 0; i < by_name.size(); ++i) by_name[i] = i;
    std::sort(by_name.begin(), by_name.end(), [&m](std::size_t a, std::size_t b) {
        const int order = compare_text(m.components[a].name, m.components[b].name);
        return order != 0 ? order < 0 : a < b;
    });
}

/// Like find_component, in logarithmic time: the compiler resolves tables of hundreds of components.
constexpr std::size_t find_component(const MachineView& m, std::span<const std::size_t> by_name,
                                     std::string_view name) noexcept {
    std::size_t low = 0;
    std::size_t high = by_name.size();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        const int order = compare_text(m.components[by_name[middle]].name, name);
        if (order == 0) return by_name[middle];
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return nowhere;
}

constexpr std::size_t find_activity(const MachineView& m, std::string_view name) noexcept {
    for (std::size_t i = 0; i < m.activities.size(); ++i)
        if (same_text(m.activities[i].name, name)) return i;
    return nowhere;
}

constexpr std::size_t find_facet(const ComponentRow& row, std::string_view name) noexcept {
    std::size_t i = 0;
    for (const Facet& facet : row.type->facets) {
        if (same_text(facet.name, name)) return i;
        ++i;
    }
    return nowhere;
}

/// Whether a component of the type has such a facet. Depends on the type alone, so that a compiler that
/// caches constant calls examines each type once.
template <class Wanted>
constexpr bool has_facet(const ComponentType* type, Wanted wanted) noexcept {
    for (const Facet& facet : type->facets)
        if (wanted(facet)) return true;
    return false;
}

constexpr const Facet& facet_at(const MachineView& m, End end) noexcept {
    return m.components[end.component].type->facets[end.facet];
}

/// The activity that runs a component, or nowhere.
constexpr std::size_t activity_of(const MachineView& m, std::string_view component) noexcept {
    for (std::size_t i = 0; i < m.activities.size(); ++i)
        for (const auto& name : m.activities[i].runs)
            if (name == component) return i;
    return nowhere;
}

constexpr Sentence unknown_component(const MachineView& m, std::string_view name) {
    Nearest nearest{name};
    for (const auto& row : m.components) nearest.consider(row.name);
    Sentence text{"there is no component \"", name, "\""};
    detail::add_suggestion(text, nearest, "add it to components(...)");
    return text;
}

/// Finds "component.facet". `wanted` is the expected kind, for the suggestion. On success sets `found` and
/// returns an empty sentence, otherwise the fault and its cure.
constexpr Sentence resolve(const MachineView& m, std::span<const std::size_t> by_name, std::string_view path,
                           FacetKind wanted, End& found) {
    const std::size_t dot = find_character(path, '.');
    if (dot == std::string_view::npos)
        return Sentence{"\"", path, "\" is not of the form \"component.",
                        wanted == FacetKind::input ? "port"
                                                   : to_text(wanted).substr(to_text(wanted).find(' ') + 1),
                        "\"; name both"};
    const std::string_view component_name = path.substr(0, dot);
    const std::string_view facet_name = path.substr(dot + 1);
    const std::size_t component =
        by_name.empty() ? find_component(m, component_name) : find_component(m, by_name, component_name);
    if (component == nowhere) return unknown_component(m, component_name);
    const ComponentRow& row = m.components[component];
    const std::size_t facet = find_facet(row, facet_name);
    if (facet == nowhere) {
        Nearest nearest{facet_name};
        for (const auto& each : row.type->facets)
            if (each.kind == wanted) nearest.consider(each.name);
        Sentence text{"component \"",
                      component_name,
                      "\" has no ",
                      to_text(wanted).substr(to_text(wanted).find(' ') + 1),
                      " \"",
                      facet_name,
                      "\""};
        detail::add_suggestion(text, nearest, "add it to the component's interface");
        return text;
    }
    found = {component, facet};
    return {};
}

/// Resolves without a list sorted by name.
constexpr Sentence resolve(const MachineView& m, std::string_view path, FacetKind wanted, End& found) {
    return resolve(m, {}, path, wanted, found);
}

} // namespace tappet

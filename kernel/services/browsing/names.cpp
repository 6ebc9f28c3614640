// Looks names up in the table, and suggests the probable name.
#include "kernel/services/browsing/names.hpp"

#include <algorithm>

namespace tappet::browsing {

namespace {

/// Names come from outside: a long one is cut in a sentence.
std::string_view shown(std::string_view name) noexcept { return name.substr(0, nearest_max_length); }

Sentence with_nearest(Sentence sentence, const Nearest& nearest, std::string_view otherwise) noexcept {
    if (nearest.best().empty()) return sentence.add("; ").add(otherwise);
    return sentence.add("; did you mean \"").add(nearest.best()).add("\"?");
}

bool is_one_of(FacetKind kind, std::initializer_list<FacetKind> kinds) noexcept {
    return kinds.size() == 0 || std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

} // namespace

Sentence find_facet(const MachineView& table, std::string_view path, std::initializer_list<FacetKind> kinds,
                    End& found) noexcept {
    const std::size_t dot = path.find('.');
    if (dot == std::string_view::npos)
        return Sentence{"\"", shown(path), "\" names no facet; write \"component.facet\""};
    const std::string_view component = path.substr(0, dot);
    const std::string_view name = path.substr(dot + 1);
    found.component = find_component(table, component);
    if (found.component == nowhere) {
        Nearest nearest{component};
        for (const ComponentRow& row : table.components) nearest.consider(row.name);
        return with_nearest(Sentence{"there is no component \"", shown(component), "\""}, nearest,
                            "list the components");
    }
    const auto facets = table.components[found.component].type->facets;
    Nearest nearest{name};
    for (found.facet = 0; found.facet < facets.size(); ++found.facet) {
        if (is_one_of(facets[found.facet].kind, kinds)) nearest.consider(facets[found.facet].name);
        if (facets[found.facet].name != name) continue;
        if (is_one_of(facets[found.facet].kind, kinds)) return {};
        Sentence sentence{"\"", shown(path), "\" is ", to_text(facets[found.facet].kind), ", not "};
        for (const FacetKind& kind : kinds)
            sentence.add(&kind == kinds.begin() ? "" : " or ").add(to_text(kind));
        return sentence.add("; name one of these");
    }
    return with_nearest(Sentence{"component \"", component, "\" has no such facet as \"", shown(name), "\""},
                        nearest, "list its facets");
}

Sentence find_life(const MachineView& table, std::string_view name, LifeTarget& found) noexcept {
    constexpr std::string_view prefix = "activity:";
    const bool is_activity = name.starts_with(prefix);
    if (is_activity) name.remove_prefix(prefix.size());
    if (!is_activity) found.component = find_component(table, name);
    if (found.component != nowhere) return {};
    found.activity = find_activity(table, name);
    if (found.activity != nowhere) return {};
    Nearest nearest{name};
    if (!is_activity)
        for (const ComponentRow& row : table.components) nearest.consider(row.name);
    for (const ActivityRow& row : table.activities) nearest.consider(row.name);
    return with_nearest(Sentence{"there is no ", is_activity ? "activity" : "component or activity", " \"",
                                 shown(name), "\""},
                        nearest, "list them");
}

} // namespace tappet::browsing

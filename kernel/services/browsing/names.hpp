// Names in the spelling of a request: "component.facet", "component", "activity:NAME".
#pragma once

#include "kernel/machine/instance/instance.hpp"

#include <initializer_list>
#include <string_view>

namespace tappet::browsing {

/// Finds the facet, which must be of one of `kinds` if there are any. An answer that is not empty names the
/// nearest one.
Sentence find_facet(const MachineView& table, std::string_view path, std::initializer_list<FacetKind> kinds,
                    End& found) noexcept;

/// A component, or an activity as "activity:NAME"; an activity also by its plain name when no component has
/// it.
struct LifeTarget {
    std::size_t component = nowhere;
    std::size_t activity = nowhere;
};
Sentence find_life(const MachineView& table, std::string_view name, LifeTarget& found) noexcept;

} // namespace tappet::browsing

// The machine table: five sections of rows that define a machine, followed by the sections of other folders.
// One value, one page.
#pragma once

#include "kernel/machine/table/rows.hpp"
#include "kernel/machine/table/section.hpp"

#include <array>
#include <span>
#include <string_view>

namespace tappet {

/// A table as spans, independent of its sizes; checks, planning and start-up read it.
struct MachineView {
    std::string_view name{};
    std::span<const ComponentRow> components;
    std::span<const ActivityRow> activities;
    std::span<const ConnectionRow> connections;
    std::span<const ReactionRow> reactions;
    std::span<const BehaviourRow> behaviours;
    const ExtraList* extras = &no_extras;
    /// The build states it: clang followed the effects of all real-time functions of the components.
    /// Otherwise the machine arms on the host and the bench only.
    bool effects_checked = false;
};

template <class Row, std::size_t N>
struct Section {
    std::array<Row, N> rows{};
};

template <std::size_t Components, std::size_t Activities, std::size_t Connections, std::size_t Reactions,
          std::size_t Behaviours, class... Extra>
struct Machine {
    std::string_view name{};
    std::array<ComponentRow, Components> components{};
    std::array<ActivityRow, Activities> activities{};
    std::array<ConnectionRow, Connections> connections{};
    std::array<ReactionRow, Reactions> reactions{};
    std::array<BehaviourRow, Behaviours> behaviours{};
    ExtraSections<Extra...> extras{};

    [[nodiscard]] constexpr MachineView view() const noexcept {
        return {name, components, activities, connections, reactions, behaviours, &extras};
    }
};

// Each section is a pack of rows of one plain type: the only template argument left is their number.
template <class... Rows>
constexpr Section<ComponentRow, sizeof...(Rows)> components(const Rows&... rows) {
    return {{rows...}};
}
template <class... Rows>
constexpr Section<ActivityRow, sizeof...(Rows)> activities(const Rows&... rows) {
    return {{rows...}};
}
template <class... Rows>
constexpr Section<ConnectionRow, sizeof...(Rows)> connections(const Rows&... rows) {
    return {{rows...}};
}
template <class... Rows>
constexpr Section<ReactionRow, sizeof...(Rows)> reactions(const Rows&... rows) {
    return {{rows...}};
}
template <class... Rows>
constexpr Section<BehaviourRow, sizeof...(Rows)> behaviours(const Rows&... rows) {
    return {{rows...}};
}

template <std::size_t C, std::size_t A, std::size_t X, std::size_t R, std::size_t B, class... Extra>
constexpr Machine<C, A, X, R, B, Extra...>
machine(std::string_view name, const Section<ComponentRow, C>& c, const Section<ActivityRow, A>& a,
        const Section<ConnectionRow, X>& x, const Section<ReactionRow, R>& r,
        const Section<BehaviourRow, B>& b, const Extra&... extra) {
    return {name, c.rows, a.rows, x.rows, r.rows, b.rows, {extra...}};
}

} // namespace tappet

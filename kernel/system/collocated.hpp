// A system without its wire: all nodes' tables as one machine, and the crossings as its rows. Components and
// their rows are the same, and so is their behaviour; only times differ.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/system/joined.hpp"

namespace tappet {

namespace systems {

/// Replaces presence: a node in the same machine is always present.
struct AlwaysThere {
    Output<bool> is_there{};
    void start(const Cycle&) noexcept TAPPET_REALTIME { is_there.write(true); }
    static constexpr auto interface() {
        return facets(output<&AlwaysThere::is_there>("is_there", "", "the others run in this machine, too",
                                                     while_stopped(false)));
    }
};
inline constexpr std::string_view always_there = "the_others";
inline constexpr std::string_view always_there_path = "the_others.is_there";

template <std::size_t C1, std::size_t A1, std::size_t X1, std::size_t R1, std::size_t B1, std::size_t C2,
          std::size_t A2, std::size_t X2, std::size_t R2, std::size_t B2>
constexpr Machine<C1 + C2, A1 + A2, X1 + X2, R1 + R2, B1 + B2> beside(const Machine<C1, A1, X1, R1, B1>& a,
                                                                      const Machine<C2, A2, X2, R2, B2>& b) {
    return {a.name,
            both(a.components, b.components),
            both(a.activities, b.activities),
            both(a.connections, b.connections),
            both(a.reactions, b.reactions),
            both(a.behaviours, b.behaviours),
            {}};
}
template <class A, class B, class C, class... More>
constexpr auto beside(const A& a, const B& b, const C& c, const More&... more) {
    return beside(beside(a, b), c, more...);
}

/// The crossings as rows of one machine.
template <const auto& system>
struct LocalRows {
    static constexpr bool is_data(const Crossing& row) {
        return row.kind == CrossingKind::data || row.kind == CrossingKind::presence;
    }
    static constexpr auto data_count =
        static_cast<std::size_t>(std::ranges::count_if(system.crossings, &LocalRows::is_data));
    static constexpr auto connections = [] {
        std::array<ConnectionRow, data_count> all{};
        std::size_t k = 0;
        for (const Crossing& row : system.crossings) {
            if (!is_data(row)) continue;
            ConnectionRow& local = all[k++];
            local = row.data;
            local.from = row.kind == CrossingKind::presence ? always_there_path : in_node(row.data.from);
            local.to = in_node(row.data.to);
        }
        return all;
    }();
    static constexpr auto reactions = [] {
        std::array<ReactionRow, system.crossings.size() - data_count> all{};
        std::size_t k = 0;
        for (const Crossing& row : system.crossings) {
            if (is_data(row)) continue;
            ReactionRow& local = all[k++];
            local = row.reaction;
            local.event = in_node(row.from());
            local.target.operation = in_node(row.to());
        }
        return all;
    }();
};

} // namespace systems

/// `tables`: those of the system's nodes, in their order, without sections of other folders. No two of them
/// may have a component, or an activity, of the same name: the check of the machine refuses it.
template <const auto& system, const auto&... tables>
inline constexpr auto collocated = [] {
    static_assert(sizeof...(tables) == system.nodes.size(), "one table for each node, in their order");
    auto all = systems::beside(tables...);
    using Rows = systems::LocalRows<system>;
    auto joined =
        systems::joined(system.name, all, std::array{component<systems::AlwaysThere>(systems::always_there)},
                        std::array<ActivityRow, 0>{}, Rows::connections, Rows::reactions);
    static_cast<void>(joined.activities[0].runs.push(systems::always_there));
    return joined;
}();

} // namespace tappet

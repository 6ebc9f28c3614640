// The places of a machine's records of its own cycles: a tape for each activity, sized by how often its row
// lets it run, and memory for the worst cycles.
#pragma once

#include "kernel/machine/plan/places.hpp"
#include "kernel/machine/plan/scope_layout.hpp"

#include <algorithm>
#include <bit>

namespace tappet {

/// Whether any component of the table records the machine's cycles.
constexpr bool records_cycles(const MachineView& m) noexcept {
    for (const ComponentRow& row : m.components)
        if (row.type->records_cycles) return true;
    return false;
}

namespace detail {

/// A tape holds this time of its activity, up to most_tape_words: a reader that polls as often sees every
/// cycle.
inline constexpr Duration tape_span = 100ms;
inline constexpr std::size_t most_tape_words = 2048;
inline constexpr std::size_t fewest_tape_words = 256;

constexpr std::size_t tape_words(const ActivityRow& row) noexcept {
    const Duration each = row.periodic() ? row.period : row.at_most_per;
    const std::int64_t runs = row.periodic() ? 1 : row.at_most_n;
    const auto cycles =
        each > Duration::zero() ? static_cast<std::size_t>(runs * (tape_span / each + 1)) : std::size_t{64};
    const std::size_t functions = row.runs.size() + 2; // each component's, and two more on average
    const std::size_t wanted = cycles * (functions + TapeCycle::words_beside_marks);
    // One cycle's marks use at most an eighth: all components may run and react in it.
    const std::size_t fewest = std::max(fewest_tape_words, 32 * (row.runs.size() + 2));
    return std::bit_ceil(std::max(fewest, std::min(wanted, most_tape_words)));
}

constexpr void plan_scope(const MachineView& m, PlanView& p, Layout& layout) {
    if (!records_cycles(m)) return;
    p.scope_at = layout.take(sizeof(scope::Directory), CycleTape::alignment);
    layout.take<scope::Tape>(m.activities.size());
    std::size_t ranked = 0;
    for (std::size_t a = 0; a < m.activities.size(); ++a) {
        p.activities[a].tape_words = tape_words(m.activities[a]);
        p.activities[a].tape_at =
            layout.take(CycleTape::bytes_for(p.activities[a].tape_words), CycleTape::alignment);
        ranked += m.activities[a].real_time;
    }
    p.recordings = ranked * scope::generations * scope::kept;
    p.recordings_at = layout.take(p.recordings * scope::recording_bytes, alignof(scope::Recording));
}

} // namespace detail

} // namespace tappet

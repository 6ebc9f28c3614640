// A state machine as plain data: two arrays of plain rows. The C++ spelling in rows.hpp, a compiled script
// and a loaded script all give this one form; the checks, the resolver, pictures and verification read
// nothing else. Thesis 5.2.1.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/base/type_tag.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

/// An entry, exit, run or transition program: called with the component.
using StateProgram = void (*)(void* component) noexcept TAPPET_REALTIME;
/// Says whether a transition may be taken. It may be asked any number of times, so it changes nothing.
using StateGuard = bool (*)(void* component) noexcept TAPPET_REALTIME;

/// Limits of one state machine. They bound the memory of the checks
/// and of the resolver, which also run on the target.
inline constexpr std::size_t max_states = 256;
inline constexpr std::size_t max_transitions = 1024;
inline constexpr std::size_t max_state_depth = 8; ///< a top state has depth 1
inline constexpr std::size_t max_state_events = 255;
/// Transitions counted once for each leaf that they lead out of, with the requests that every machine has.
inline constexpr std::size_t max_leaf_transitions = 3600;
static_assert(max_states * max_state_events <= 0xffff, "a cell of the resolved table has a 16-bit number");
static_assert(
    max_leaf_transitions * (2 * max_state_depth + 1) + max_states * 2 * max_state_depth <= 0xffff,
    "a place in the resolved list of programs has a 16-bit number: one transition calls at most its "
    "own program and an exit and an entry a level, one state at most a run and an exit a level");

struct StateRow {
    std::string_view name;
    std::string_view parent{}; ///< the composite state around it; empty: a top state
    bool initial = false;      ///< entered when its composite, or the machine, is entered
    bool final = false;        ///< the safe state of thesis 5.2.2: reachable from everywhere by request
    StateProgram entry = nullptr;
    StateProgram exit = nullptr;
    StateProgram run = nullptr;
    TypeId component = nullptr; ///< whose programs these are; nullptr: it has none
    std::string_view twice{};   ///< the part that the row was given twice; empty in a good row
};

struct TransitionRow {
    std::string_view from;
    std::string_view to;      ///< empty: internal, no state is left or entered
    std::string_view event{}; ///< "component.event" or "event" of the own component
    bool on_event = false;    ///< false: a condition transition
    bool timed = false;       ///< a condition transition that waits for `after`
    Duration after{};         ///< time since `from` was entered
    StateGuard guard = nullptr;
    StateProgram then = nullptr;
    std::string_view because{}; ///< what the operator is told
    TypeId component = nullptr;
    std::string_view twice{};
};

/// A view of a state machine; the rows live elsewhere and outlive it.
struct StateMachineTable {
    std::string_view name{};
    std::span<const StateRow> states{};
    std::span<const TransitionRow> transitions{};
    TypeId component = nullptr; ///< the type of the component that the programs run on
};

/// Number of a state: its row in the table.
using StateIndex = std::uint16_t;
inline constexpr StateIndex no_state = 0xffff;

/// Number of a transition: its row in the table, or one of those that every machine has.
using TransitionIndex = std::uint16_t;
inline constexpr TransitionIndex no_transition = 0xffff;
inline constexpr TransitionIndex start_transition = 0xfffe; ///< into the initial state
inline constexpr TransitionIndex final_transition = 0xfffd; ///< to the final state by request
inline constexpr TransitionIndex reset_transition =
    0xfffc; ///< from the final to the initial state by request
inline constexpr TransitionIndex leaving_transition = 0xfffb; ///< out of the active state, by deactivation
static_assert(max_states < no_state && max_transitions < leaving_transition,
              "the reserved numbers are no rows");

} // namespace tappet

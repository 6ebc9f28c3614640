// A state machine as plain data: two arrays of plain rows. The C++ notation in rows.hpp, a compiled script
// and a loaded script all produce this form; checks, resolver, pictures and verification read only this form.
// Thesis 5.2.1.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/program/code.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

/// An entry, exit, run or transition program; the argument is the component.
using StateProgram = void (*)(void* component) noexcept TAPPET_REALTIME;
/// Returns whether a transition may be taken. It may be called any number of times, so it must change
/// nothing.
using StateGuard = bool (*)(void* component) noexcept TAPPET_REALTIME;
/// Text for people, valid forever: a literal or the name of an enumerator.
using StateWords = std::string_view (*)(void* component) noexcept TAPPET_REALTIME;

/// Limits of one state machine. They bound the memory of the checks
/// and of the resolver, which also run on the target.
inline constexpr std::size_t max_states = 256;
inline constexpr std::size_t max_transitions = 1024;
inline constexpr std::size_t max_state_depth = 8;    ///< a top state has depth 1
inline constexpr std::size_t max_active_states = 16; ///< at the same time, in all regions
inline constexpr std::size_t max_state_events = 255;
/// Transitions, counted once for each leaf that they start from, plus the requests that every machine has.
inline constexpr std::size_t max_leaf_transitions = 3600;
static_assert(max_states * max_state_events <= 0xffff, "a cell of the resolved table has a 16-bit number");

/// A program of a state or transition: a C++ function, which is atomic, or one of the table's own programs,
/// which may take several steps.
struct ProgramRef {
    StateProgram call = nullptr;
    ProgramIndex program = no_program;

    constexpr ProgramRef() = default;
    constexpr ProgramRef(StateProgram function) : call{function} {}
    constexpr explicit ProgramRef(ProgramIndex number) : program{number} {}
    [[nodiscard]] constexpr bool empty() const noexcept TAPPET_REALTIME {
        return call == nullptr && program == no_program;
    }
};

/// A guard or a precondition: a C++ function or a condition of the table; empty: always true.
struct ConditionRef {
    StateGuard call = nullptr;
    ConditionIndex condition = no_condition;

    constexpr ConditionRef() = default;
    constexpr ConditionRef(StateGuard function) : call{function} {}
    constexpr explicit ConditionRef(ConditionIndex number) : condition{number} {}
    [[nodiscard]] constexpr bool empty() const noexcept TAPPET_REALTIME {
        return call == nullptr && condition == no_condition;
    }
};

/// The reason shown to people when a guard says no. Not evaluated in a cycle.
struct GuardReason {
    std::string_view text{};
    StateWords detail = nullptr; ///< says which of several things it is; called in the engine like the guard
};

struct StateRow {
    std::string_view name;
    std::string_view parent{}; ///< the enclosing composite state; empty: a top state
    std::string_view region{}; ///< of its composite: states of different regions are active at the same time
    bool initial = false;      ///< entered when its region, or the machine, is entered
    bool final = false;        ///< the safe state of thesis 5.2.2: reachable from everywhere by request
    ConditionRef precondition{}; ///< evaluated in addition to the guard of each transition that enters it
    GuardReason refusal{};       ///< of the precondition
    ProgramRef entry{};
    ProgramRef exit{};
    ProgramRef run{};
    ProgramRef handle{};        ///< when no transition was taken (thesis 5.2.1)
    TypeId component = nullptr; ///< type of the component that has its C++ programs; nullptr: none
    std::string_view twice{};   ///< the part that the row has twice; empty in a good row
    std::uint16_t line = 0;     ///< in the script, from 1; 0: a C++ table
    std::uint16_t column = 0;
};

/// The states inside a composite that a transition to it enters (UML 2.5.1, 14.2.3.7).
enum class EntryKind : std::uint8_t {
    initial,         ///< its initial states
    shallow_history, ///< the states last active directly inside it, and their initial states
    deep_history     ///< all states last active inside it
};

/// Copies an argument of an event into a variable.
struct CaptureRow {
    std::uint16_t from = 0;   ///< offset in the packed arguments
    std::uint16_t size = 0;   ///< bytes there
    DataOffset raw = no_data; ///< where its bytes are stored
    std::uint16_t first = 0;  ///< instructions that convert and assign it from there,
    std::uint16_t count = 0;  ///< none: it is stored in place
};

struct TransitionRow {
    std::string_view from;
    std::string_view to;      ///< empty: internal, no state is exited or entered
    std::string_view event{}; ///< "component.event" or "event" of the own component
    bool on_event = false;    ///< false: a condition transition
    bool timed = false;       ///< a condition transition that waits for `after`
    Duration after{};         ///< time since `from` was entered
    ConditionRef guard{};
    GuardReason refusal{}; ///< of the guard
    ProgramRef then{};
    std::string_view because{}; ///< the reason shown to the operator
    TypeId component = nullptr;
    std::string_view twice{};
    EntryKind enters = EntryKind::initial;
    ProgramRef otherwise{};          ///< runs when the guard says no: else of thesis listing 5.4,
    std::string_view otherwise_to{}; ///< and the state entered then; empty: none
    bool has_otherwise = false;
    std::uint16_t first_capture = 0; ///< CaptureRow
    std::uint16_t captures = 0;
    std::uint16_t line = 0;
    std::uint16_t column = 0;
};

/// A view of a state machine; its rows must outlive it.
struct StateMachineTable {
    std::string_view name{};
    std::span<const StateRow> states{};
    std::span<const TransitionRow> transitions{};
    TypeId component = nullptr; ///< the type of the component that the programs run on
    const ProgramTables* programs =
        nullptr; ///< the tables that ProgramRef and ConditionRef index; null: C++ programs only
    std::span<const CaptureRow> captures{};
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
inline constexpr TransitionIndex leaving_transition = 0xfffb; ///< exits all states, by deactivation
static_assert(max_states < no_state && max_transitions < leaving_transition,
              "the reserved numbers are no rows");

} // namespace tappet

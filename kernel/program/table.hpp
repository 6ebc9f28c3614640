// A program as plain data (thesis 5.1.1): nodes with one action each, arcs with conditions, and the
// expressions in both. Scripts, compiled or loaded, produce this form; execution, checks, pictures and
// verification read only this form.
#pragma once

#include "kernel/base/realtime.hpp"
#include "kernel/base/time.hpp"
#include "kernel/base/type_tag.hpp"
#include "kernel/component/facet.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tappet {

struct ProgramContext;
struct Instruction;

/// Result of an instruction.
enum class ActionResult : std::uint8_t {
    done,
    again, ///< it could not act yet: the next step executes the node's action again
    skip,  ///< done; the next `size` instructions are skipped, as the right operand of && and || may be
    failed ///< the program is in error, or continues at its node's on_error (thesis 5.1.1)
};

/// Location of a value: bytes from the beginning of the program's data, see DataLayout.
using DataOffset = std::uint16_t;
inline constexpr DataOffset no_data = 0xffff;

/// The function of an instruction. `to`, `a` and `b` are the values at the instruction's offsets. The loaded
/// form calls it through the pointer; in the compiled form the instruction is a constant and the call is
/// inlined. Bounded, real-time.
using Primitive = ActionResult (*)(ProgramContext&, const Instruction&, std::byte* to, const std::byte* a,
                                   const std::byte* b) noexcept TAPPET_REALTIME;

/// One step of an expression or of an action.
struct Instruction {
    Primitive run = nullptr;
    const Facet* facet = nullptr; ///< of the link, when it acts on a component
    DataOffset to = no_data;
    DataOffset a = no_data;
    DataOffset b = no_data;
    std::uint16_t link = 0xffff; ///< number of the LinkRow that it acts through
    std::uint16_t size = 0;      ///< bytes, or another number that the primitive defines
    std::uint8_t rows = 0; ///< of matrices: `to` is rows x columns, `a` rows x inner, `b` inner x columns
    std::uint8_t inner = 0;
    std::uint8_t columns = 0;
    const RecordField* field = nullptr; ///< of a record: its offset is known when the program runs

    /// A second number, for instructions without rows and inner.
    [[nodiscard]] constexpr std::size_t count() const noexcept TAPPET_REALTIME {
        return static_cast<std::size_t>(rows | inner << 8);
    }
};

/// A sequence of instructions; the last one leaves a bool at `result`.
struct ConditionRow {
    std::uint16_t first = 0;
    std::uint16_t count = 0;
    DataOffset result = no_data;
};
using ConditionIndex = std::uint16_t;
inline constexpr ConditionIndex no_condition = 0xffff; ///< always true

using NodeIndex = std::uint16_t;
inline constexpr NodeIndex no_node = 0xffff;  ///< the program is in error
inline constexpr NodeIndex end_node = 0xfffe; ///< the program has ended

/// One exit of a node; after the node's action, its arcs are evaluated in order.
struct ArcRow {
    ConditionIndex condition = no_condition;
    NodeIndex to = end_node;
    /// A Duration: the arc stays closed until so much time has passed since the node was entered. With a
    /// condition, both must hold.
    DataOffset after = no_data;
};

/// One statement. Without an open arc the program waits here; the action is not repeated unless it returned
/// `again` (thesis 5.1.3, 5.1.5).
struct NodeRow {
    std::uint16_t first = 0; ///< instruction
    std::uint16_t count = 0;
    std::uint16_t first_arc = 0;
    std::uint16_t arcs = 0;
    NodeIndex on_error = no_node;
    std::uint16_t line = 0; ///< of the script, from 1
    std::uint16_t column = 0;
    bool yields = false; ///< its arcs are evaluated from the next step on
};

using ProgramIndex = std::uint16_t;
inline constexpr ProgramIndex no_program = 0xffff;

struct ProgramRow {
    std::string_view name{}; ///< "Positioning.run"
    NodeIndex first = end_node;
    NodeIndex last = end_node; ///< its nodes are first ... last - 1, in text order
    bool may_wait = false;     ///< it may need more than one step; otherwise it is atomic
};

enum class VariableKind : std::uint8_t {
    parameter,
    variable,
    constant,
    argument,
    result ///< of a program, returned to the sender of the command
};

/// A named value of a program or state machine: peers see it as a property (thesis 5.1.6).
struct VariableRow {
    std::string_view name{};
    TypeId type = nullptr;
    DataOffset at = no_data;
    VariableKind kind = VariableKind::variable;
};

/// The part of a component that a program acts on: resolved to addresses once, when the program is bound.
struct LinkRow {
    static constexpr std::uint16_t component_itself = 0xffff;
    std::uint16_t peer = 0;                 ///< number in the reach
    std::uint16_t facet = component_itself; ///< number among that component's facets
    bool needs_slot = false;                ///< a command of another activity
};

/// An order of a program to a component: an operation that it calls, an event that it emits, an output that
/// it writes. See kernel/program/orders.hpp.
struct ProgramOrder {
    std::uint16_t link = 0; ///< number of the LinkRow
    NodeIndex node = no_node;
    bool is_constant = false; ///< of an output: it is written with a constant
    double value = 0;         ///< that constant
};

/// The data of one program instance, one piece of memory:
///     [0, constants)            constants, never written
///     [constants, variables)    parameters and variables; kept from step to step
///     [variables, arguments)    of the current event, of functions and waits; kept while a program runs
///     [arguments, size)         scratch: written before it is read within one node
struct DataLayout {
    DataOffset constants = 0;
    DataOffset variables = 0;
    DataOffset arguments = 0;
    DataOffset size = 0;
};

/// Alignment of each value and of the block.
inline constexpr std::size_t data_alignment = 16;

/// All programs of one state machine type, or one program alone; a view, its rows must outlive it.
struct ProgramTables {
    std::span<const Instruction> instructions{};
    std::span<const ConditionRow> conditions{};
    std::span<const NodeRow> nodes{};
    std::span<const ArcRow> arcs{};
    std::span<const ProgramRow> programs{};
    std::span<const VariableRow> variables{};
    std::span<const LinkRow> links{};
    std::span<const std::byte> image{}; ///< initial data: constants and initial values, `variables` bytes
    DataLayout layout{};
};

} // namespace tappet

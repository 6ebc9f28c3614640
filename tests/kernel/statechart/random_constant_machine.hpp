// Random state machines as constants: their programs wait, fail, raise events and request the final state.
// The same seed gives the same machine, in a constant expression.
#pragma once

#include "kernel/statechart/native.hpp"
#include "tests/kernel/program/random_tables.hpp"

#include <array>

namespace tappet::random_machines {

inline constexpr std::array<std::string_view, 3> events{"go", "stop", "mark"};

/// The component: an order-dependent sum of its calls, and the way back to its machine.
struct Witness {
    std::uint64_t sum = 0;
    std::uint32_t calls = 0;
    StateMachineExecution* machine = nullptr;
    Time now{};

    void note(std::uint64_t what) noexcept TAPPET_REALTIME {
        ++calls;
        sum = sum * 1'000'003 + what;
    }
};

inline Witness& witness_of(void* component) noexcept TAPPET_REALTIME {
    return *static_cast<Witness*>(component);
}
inline void plain(void* component) noexcept TAPPET_REALTIME { witness_of(component).note(11); }
inline void raises(void* component) noexcept TAPPET_REALTIME {
    Witness& seen = witness_of(component);
    seen.note(12);
    constexpr std::int64_t argument = 5;
    std::array<std::byte, sizeof argument> packed{};
    std::memcpy(packed.data(), &argument, sizeof argument);
    static_cast<void>(seen.machine->dispatch(seen.calls % events.size(), seen.now, packed.data()));
}
inline void gives_up(void* component) noexcept TAPPET_REALTIME {
    Witness& seen = witness_of(component);
    seen.note(13);
    if (seen.calls % 5 == 0) static_cast<void>(seen.machine->request_final(seen.now, "it gave up"));
}
inline bool often(void* component) noexcept TAPPET_REALTIME { return witness_of(component).calls % 4 != 0; }
inline bool seldom(void* component) noexcept TAPPET_REALTIME { return witness_of(component).calls % 4 == 1; }

inline ActionResult notes(ProgramContext& context, const Instruction& in, std::byte*, const std::byte* a,
                          const std::byte*) noexcept TAPPET_REALTIME {
    witness_of(context.component).note(in.size + static_cast<std::uint64_t>(load_value<ScriptInt>(a)));
    return ActionResult::done;
}
inline ActionResult hesitates(ProgramContext& context, const Instruction&, std::byte*, const std::byte*,
                              const std::byte*) noexcept TAPPET_REALTIME {
    Witness& seen = witness_of(context.component);
    seen.note(14);
    return seen.calls % 3 == 0 ? ActionResult::done : ActionResult::again;
}

using random_tables::Random, random_tables::add, random_tables::remainder, random_tables::less;

inline constexpr std::size_t program_count = 10;
inline constexpr std::size_t nodes_each = 3;
inline constexpr std::size_t condition_count = 6;
inline constexpr std::size_t state_count = 7;
inline constexpr std::size_t extra_transitions = 10;
inline constexpr std::size_t transition_count = extra_transitions + 8;

constexpr DataOffset place(std::size_t i) { return static_cast<DataOffset>(i * data_alignment); }
inline constexpr std::size_t constants = 3, variables = 4;
inline constexpr DataOffset limit = place(constants + variables); ///< the Duration of a wait
inline constexpr DataOffset scratch = place(constants + variables + 1);
inline constexpr std::size_t data_bytes = place(constants + variables + 3);

struct Rows {
    bool folded = false; ///< C++ functions only
    std::array<Instruction, program_count * nodes_each * 3 + condition_count * 2 + 1> instructions{};
    std::array<ConditionRow, condition_count> conditions{};
    std::array<NodeRow, program_count * nodes_each> nodes{};
    std::array<ArcRow, program_count * nodes_each * 2> arcs{};
    std::array<ProgramRow, program_count> programs{};
    std::array<std::byte, place(constants + variables)> image{};
    std::array<StateRow, state_count> states{};
    std::array<TransitionRow, transition_count> transitions{};
    std::array<CaptureRow, 1> captures{};

    [[nodiscard]] constexpr ProgramTables tables() const {
        return {.instructions = instructions,
                .conditions = conditions,
                .nodes = nodes,
                .arcs = arcs,
                .programs = programs,
                .image = image,
                .layout = {place(constants), limit, scratch, data_bytes}};
    }
};

constexpr DataOffset some_operand(Random& random) { return place(random(constants + variables)); }
constexpr DataOffset variable(Random& random) { return place(constants + random(variables)); }

constexpr void fill_programs(Random& random, Rows& rows) {
    std::uint16_t used = 0;
    for (ConditionRow& row : rows.conditions) {
        row = {used, 2, static_cast<DataOffset>(scratch + data_alignment)};
        rows.instructions[used++] = {.run = random.one_in(5) ? remainder : add,
                                     .to = scratch,
                                     .a = some_operand(random),
                                     .b = some_operand(random)};
        rows.instructions[used++] = {.run = less, .to = row.result, .a = scratch, .b = some_operand(random)};
    }
    for (std::size_t p = 0; p < program_count; ++p) {
        bool waits = false;
        const std::size_t first = p * nodes_each;
        rows.programs[p] = {.first = static_cast<NodeIndex>(first),
                            .last = static_cast<NodeIndex>(first + nodes_each)};
        for (std::size_t n = first; n < first + nodes_each; ++n) {
            NodeRow& node = rows.nodes[n];
            node.first = used;
            rows.instructions[used++] = {.run = random.one_in(12) ? remainder : add,
                                         .to = scratch,
                                         .a = some_operand(random),
                                         .b = some_operand(random)};
            if (random.one_in(2))
                rows.instructions[used++] = {
                    .run = &primitive::copy, .to = variable(random), .a = scratch, .size = 8};
            if (p % 3 == 0 && random.one_in(3)) {
                rows.instructions[used++] = {.run = &hesitates};
                waits = true;
            } else
                rows.instructions[used++] = {
                    .run = &notes, .a = scratch, .size = static_cast<std::uint16_t>(n)};
            node.count = static_cast<std::uint16_t>(used - node.first);
            node.first_arc = static_cast<std::uint16_t>(n * 2);
            const NodeIndex next = n + 1 < first + nodes_each ? static_cast<NodeIndex>(n + 1) : end_node;
            node.arcs = 2;
            rows.arcs[n * 2] = {.condition = static_cast<ConditionIndex>(random(condition_count)),
                                .to = random.one_in(3) ? end_node : next};
            rows.arcs[n * 2 + 1] = {.to = next};
            if (p % 3 == 0 && random.one_in(3)) {
                rows.arcs[n * 2 + 1].after = limit;
                waits = true;
            }
            if (random.one_in(3)) node.on_error = next == end_node ? no_node : next;
        }
        rows.programs[p].may_wait = waits;
    }
    rows.captures[0] = {.from = 0, .size = 8, .raw = scratch, .first = used, .count = 1};
    rows.instructions[used++] = {.run = &primitive::copy, .to = place(constants), .a = scratch, .size = 8};
}

constexpr ProgramRef some_program(Random& random, bool folded) {
    const std::uint64_t kind = random(8);
    if (kind < 2) return {};
    if (kind == 2) return &plain;
    if (kind == 3 && random.one_in(2)) return random.one_in(2) ? &raises : &gives_up;
    return folded ? ProgramRef{&plain} : ProgramRef{static_cast<ProgramIndex>(random(program_count))};
}
constexpr ConditionRef some_guard(Random& random, bool folded) {
    if (random.one_in(2) || folded) return random.one_in(2) ? &often : &seldom;
    return ConditionRef{static_cast<ConditionIndex>(random(condition_count))};
}

constexpr void fill_machine(Random& random, Rows& rows) {
    const bool folded = rows.folded;
    rows.states = {
        StateRow{.name = "a", .initial = true}, StateRow{.name = "b", .parent = "a", .initial = true},
        StateRow{.name = "c", .parent = "a"},   StateRow{.name = "d", .parent = "c", .initial = true},
        StateRow{.name = "e", .parent = "c"},   StateRow{.name = "f"},
        StateRow{.name = "safe", .final = true}};
    for (StateRow& row : rows.states) {
        row.entry = some_program(random, folded);
        row.exit = some_program(random, folded);
        row.run = some_program(random, folded);
        row.handle = some_program(random, folded);
        if (!folded && random.one_in(6)) row.precondition = some_guard(random, folded);
    }
    // Every state can be reached and left.
    constexpr std::array<std::array<std::string_view, 2>, 8> ways{{{"b", "c"},
                                                                   {"d", "e"},
                                                                   {"e", "f"},
                                                                   {"f", "a"},
                                                                   {"c", "b"},
                                                                   {"f", "safe"},
                                                                   {"safe", "f"},
                                                                   {"a", "f"}}};
    std::size_t used = 0;
    for (const auto& way : ways) {
        rows.transitions[used++] = {.from = way[0],
                                    .to = way[1],
                                    .event = events[random(events.size())],
                                    .on_event = true,
                                    .guard = some_guard(random, folded),
                                    .then = some_program(random, folded)};
    }
    for (; used < transition_count; ++used) {
        TransitionRow& row = rows.transitions[used];
        row.from = rows.states[random(state_count - 1)].name;
        row.guard = some_guard(random, folded);
        row.then = some_program(random, folded);
        if (!random.one_in(5)) row.to = rows.states[random(state_count)].name;
        row.on_event = row.to.empty() || random.one_in(2);
        if (row.to.empty() && row.then.empty()) row.then = &plain;
        if (random.one_in(3)) row.because = "because of that";
        if (row.on_event) {
            row.event = events[random(events.size())];
            row.captures = !folded && random.one_in(2) ? 1 : 0;
            row.has_otherwise = !folded && random.one_in(3);
            if (row.has_otherwise) {
                row.otherwise = some_program(random, folded);
                if (random.one_in(2)) row.otherwise_to = rows.states[random(state_count)].name;
            }
        } else if (random.one_in(2)) {
            row.timed = true;
            row.after = Duration{1 + static_cast<std::int64_t>(random(60))};
        }
    }
}

constexpr Rows random_rows(std::uint64_t seed, bool folded) {
    Random random{seed};
    Rows rows;
    rows.folded = folded;
    fill_programs(random, rows);
    fill_machine(random, rows);
    for (std::size_t i = 0; i < constants + variables; ++i)
        store_value(rows.image.data() + place(i), static_cast<ScriptInt>(random(6)) - 1);
    return rows;
}

/// The source of native code.
struct Source {
    StateMachineTable table{};
    const ProgramTables* tables = nullptr;
};
constexpr StateMachineTable machine_of(const Source& source, std::size_t) noexcept { return source.table; }
constexpr const ProgramTables& tables_of(const Source& source, std::size_t) noexcept {
    return *source.tables;
}

template <std::uint64_t seed, bool folded> inline constexpr Rows rows = random_rows(seed, folded);
template <std::uint64_t seed, bool folded> inline constexpr ProgramTables tables =
    rows<seed, folded>.tables();
template <std::uint64_t seed, bool folded>
inline constexpr Source machine{{.name = "random",
                                 .states = rows<seed, folded>.states,
                                 .transitions = rows<seed, folded>.transitions,
                                 .programs = folded ? nullptr : &tables<seed, folded>,
                                 .captures = rows<seed, folded>.captures},
                                &tables<seed, folded>};

} // namespace tappet::random_machines

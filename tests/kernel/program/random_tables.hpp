// Random programs: any node may lead to any other, wait, repeat, yield, return again or fail. The same seed
// gives the same table, in a constant expression.
#pragma once

#include "kernel/program/primitives_scalar.hpp"
#include "kernel/program/primitives_value.hpp"

#include <array>
#include <cstdint>

namespace tappet::random_tables {

/// The component: an order-dependent sum of its calls.
struct Witness {
    std::uint64_t done = 0;
    std::uint32_t calls = 0;
};

inline ActionResult witness(ProgramContext& context, const Instruction& in, std::byte*, const std::byte* a,
                            const std::byte*) noexcept TAPPET_REALTIME {
    auto& seen = *static_cast<Witness*>(context.component);
    ++seen.calls;
    seen.done = seen.done * 1'000'003 + in.size + static_cast<std::uint64_t>(load_value<ScriptInt>(a));
    return ActionResult::done;
}
/// Returns `again` in two of three calls.
inline ActionResult hesitate(ProgramContext& context, const Instruction& in, std::byte*, const std::byte*,
                             const std::byte*) noexcept TAPPET_REALTIME {
    auto& seen = *static_cast<Witness*>(context.component);
    ++seen.calls;
    seen.done = seen.done * 1'000'003 + in.size;
    return seen.calls % 3 == 0 ? ActionResult::done : ActionResult::again;
}

inline constexpr Primitive add = &primitive::binary<ScriptInt, ScriptInt, ScriptInt,
                                                    &primitive::add_integer<ScriptInt, ScriptInt, ScriptInt>>;
inline constexpr Primitive multiply =
    &primitive::binary<ScriptInt, ScriptInt, ScriptInt,
                       &primitive::multiply_integer<ScriptInt, ScriptInt, ScriptInt>>;
inline constexpr Primitive remainder =
    &primitive::binary<ScriptInt, ScriptInt, ScriptInt,
                       &primitive::remainder_integer<ScriptInt, ScriptInt, ScriptInt>>;
inline constexpr Primitive less = &primitive::binary<ScriptInt, ScriptInt, bool, &primitive::less<ScriptInt>>;

inline constexpr std::size_t node_count = 24;
inline constexpr std::size_t arcs_each = 3;
inline constexpr std::size_t condition_count = 6;
inline constexpr std::size_t places = 4; ///< number of constants, and of variables

constexpr DataOffset constant(std::size_t i) { return static_cast<DataOffset>(i * data_alignment); }
constexpr DataOffset variable(std::size_t i) { return constant(places + i); }
constexpr DataOffset kept(std::size_t i) { return constant(2 * places + i); }
constexpr DataOffset scratch(std::size_t i) { return constant(2 * places + 2 + i); }

struct Random {
    std::uint64_t state;
    constexpr std::uint64_t operator()(std::uint64_t below) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return (state >> 33) % below;
    }
    constexpr bool one_in(std::uint64_t n) { return (*this)(n) == 0; }
};

struct Rows {
    std::array<Instruction, node_count * 4 + condition_count * 2> instructions{};
    std::array<ConditionRow, condition_count> conditions{};
    std::array<NodeRow, node_count> nodes{};
    std::array<ArcRow, node_count * arcs_each> arcs{};
    std::array<ProgramRow, 2> programs{};
    std::array<std::byte, 2 * places * data_alignment> image{};

    [[nodiscard]] constexpr ProgramTables view() const {
        return {.instructions = instructions,
                .conditions = conditions,
                .nodes = nodes,
                .arcs = arcs,
                .programs = programs,
                .image = image,
                .layout = {constant(places), constant(2 * places), scratch(0), scratch(4)}};
    }
};

constexpr DataOffset operand(Random& random) {
    return random(2) == 0 ? constant(random(places)) : variable(random(places));
}

// One instruction into `to`; the last of a node often controls the execution itself.
constexpr Instruction computes(Random& random, DataOffset to) {
    constexpr std::array<Primitive, 3> all{add, multiply, remainder};
    return {.run = all[random(all.size())], .to = to, .a = operand(random), .b = operand(random)};
}

constexpr void fill_node(Random& random, Rows& rows, std::size_t node, std::uint16_t& used) {
    NodeRow& row = rows.nodes[node];
    row.first = used;
    const auto give = [&](const Instruction& in) {
        rows.instructions[used++] = in;
        ++row.count;
    };
    switch (random(8)) {
    case 0:
        give({.run = less, .to = scratch(1), .a = operand(random), .b = operand(random)});
        give({.run = random(2) == 0 ? &primitive::skip_if : &primitive::skip_unless,
              .a = scratch(1),
              .size = static_cast<std::uint16_t>(1 + random(2))});
        give(computes(random, variable(random(places))));
        give({.run = &witness, .a = operand(random), .size = static_cast<std::uint16_t>(node)});
        break;
    case 1: give({.run = &hesitate, .size = static_cast<std::uint16_t>(node)}); break;
    case 2:
        give({.run = &primitive::elapsed, .to = scratch(2)});
        give({.run = &witness, .a = scratch(2), .size = static_cast<std::uint16_t>(node)});
        break;
    case 3: break;
    default:
        give(computes(random, scratch(0)));
        give({.run = &primitive::copy, .to = variable(random(places)), .a = scratch(0), .size = 8});
        give({.run = &witness, .a = operand(random), .size = static_cast<std::uint16_t>(node)});
    }
    row.first_arc = static_cast<std::uint16_t>(node * arcs_each);
    row.yields = random(6) == 0;
    if (random(3) == 0) row.on_error = static_cast<NodeIndex>(random(node_count));
    for (std::size_t i = 0; i < arcs_each; ++i) {
        ArcRow& arc = rows.arcs[node * arcs_each + i];
        ++row.arcs;
        const std::uint64_t where = random(16);
        const std::size_t near = node + 1 + random(4);
        arc.to = where == 0 || near >= node_count ? end_node
                 : where < 6                      ? static_cast<NodeIndex>(random(node_count))
                                                  : static_cast<NodeIndex>(near);
        const std::uint64_t kind = random(4);
        if (kind != 0) arc.condition = static_cast<ConditionIndex>(random(condition_count));
        if (kind == 2) arc.after = kept(random(2));
        if (kind == 0) break; // open
    }
}

constexpr Rows random_rows(std::uint64_t seed) {
    Random random{seed};
    Rows rows;
    std::uint16_t used = 0;
    for (std::size_t i = 0; i < condition_count; ++i) {
        ConditionRow& row = rows.conditions[i];
        row.first = used;
        // Some fail: a remainder by zero.
        rows.instructions[used++] = {.run = random(3) == 0 ? remainder : add,
                                     .to = scratch(0),
                                     .a = operand(random),
                                     .b = operand(random)};
        rows.instructions[used++] = {.run = less, .to = scratch(1), .a = scratch(0), .b = operand(random)};
        row.count = 2;
        row.result = scratch(1);
    }
    for (std::size_t node = 0; node < node_count; ++node) fill_node(random, rows, node, used);
    rows.programs = {
        ProgramRow{.name = "first", .first = 0, .last = node_count / 2, .may_wait = true},
        ProgramRow{.name = "second", .first = node_count / 2, .last = node_count, .may_wait = true}};
    for (std::size_t i = 0; i < 2 * places; ++i)
        store_value(rows.image.data() + i * data_alignment, static_cast<ScriptInt>(random(7)) - 2);
    return rows;
}

} // namespace tappet::random_tables

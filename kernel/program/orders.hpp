// The orders that programs give to components: operations that they call, events that they emit, outputs that
// they write. Checks of the machine table read them; native code keeps them in place of its instructions.
#pragma once

#include "kernel/program/primitives_facet.hpp"
#include "kernel/program/table.hpp"

#include <array>

namespace tappet {

namespace detail {

/// Returns a constant of a program's data as a number, of the types that an output of a device can have.
constexpr bool read_constant(const ProgramTables& tables, DataOffset at, TypeId type, double& into) {
    if (at == no_data || at + type->size > tables.layout.constants || at + type->size > tables.image.size() ||
        type->size > 8 || !(type->arithmetic || type == type_id<bool>))
        return false;
    std::uint64_t bits = 0;
    for (std::size_t i = type->size; i-- > 0;)
        bits = bits << 8 | std::to_integer<std::uint64_t>(tables.image[at + i]);
    const std::size_t above = 64 - 8 * type->size;
    if (type->kind == ValueKind::real)
        into = type->size == sizeof(double) ? std::bit_cast<double>(bits)
                                            : double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
    else if (type->kind == ValueKind::integer)
        into = static_cast<double>(static_cast<std::int64_t>(bits << above) >> above);
    else
        into = static_cast<double>(bits);
    return true;
}

} // namespace detail

/// Calls visit(ProgramOrder) for each order, in the order of the text.
template <class Visit> constexpr void for_each_order(const ProgramTables& tables, const Visit& visit) {
    for (std::size_t n = 0; n < tables.nodes.size(); ++n)
        for (const Instruction& in : tables.instructions.subspan(
                 tables.nodes[n].first, tables.instructions.empty() ? 0 : tables.nodes[n].count)) {
            const bool writes = in.run == &primitive::write_output;
            if (!writes && in.run != &primitive::call_operation && in.run != &primitive::emit_event) continue;
            ProgramOrder order{.link = in.link, .node = static_cast<NodeIndex>(n)};
            order.is_constant = writes && detail::read_constant(tables, in.a, in.facet->type, order.value);
            visit(order);
        }
}
constexpr std::size_t count_orders(const ProgramTables& tables) {
    std::size_t count = 0;
    for_each_order(tables, [&](const ProgramOrder&) { ++count; });
    return count;
}
template <std::size_t N> constexpr std::array<ProgramOrder, N> copy_orders(const ProgramTables& tables) {
    std::array<ProgramOrder, N> all{};
    std::size_t n = 0;
    for_each_order(tables, [&](const ProgramOrder& order) { all[n++] = order; });
    return all;
}

} // namespace tappet

// Verifies a program's tables before they are executed: in tables that pass, no row points outside the
// tables, the data or the links, whatever produced them.
#pragma once

#include "kernel/base/text.hpp"
#include "kernel/program/code.hpp"

namespace tappet {

namespace detail {

class TableCheck {
public:
    explicit constexpr TableCheck(const ProgramTables& tables) noexcept : tables_{tables} {}

    constexpr Sentence check() {
        const DataLayout& data = tables_.layout;
        if (data.constants > data.variables || data.variables > data.arguments || data.arguments > data.size)
            return Sentence{"the parts of its data do not stand in their order"};
        if (tables_.image.size() > data.variables) return Sentence{"its image is longer than its variables"};
        if (tables_.nodes.size() > most_nodes) return Sentence{"it has more nodes than have numbers"};
        for (std::size_t i = 0; i < tables_.instructions.size(); ++i)
            if (!is_good(tables_.instructions[i])) return fault("instruction", i);
        for (std::size_t i = 0; i < tables_.conditions.size(); ++i)
            if (!is_good(tables_.conditions[i])) return fault("condition", i);
        for (std::size_t i = 0; i < tables_.arcs.size(); ++i)
            if (!is_good(tables_.arcs[i])) return fault("arc", i);
        for (std::size_t i = 0; i < tables_.nodes.size(); ++i)
            if (!is_good(tables_.nodes[i])) return fault("node", i);
        for (std::size_t i = 0; i < tables_.programs.size(); ++i)
            if (!is_good(tables_.programs[i])) return fault("program", i);
        for (std::size_t i = 0; i < tables_.variables.size(); ++i)
            if (!is_good(tables_.variables[i])) return fault("variable", i);
        return {};
    }

private:
    static constexpr std::size_t most_nodes = end_node - 1;

    static constexpr Sentence fault(std::string_view what, std::size_t number) {
        return Sentence{what, " ", number, " leads out of the tables"};
    }
    static constexpr bool fits(std::size_t first, std::size_t count, std::size_t size) noexcept {
        return first <= size && count <= size - first;
    }
    [[nodiscard]] constexpr bool reads(DataOffset at) const noexcept {
        return at == no_data || at < tables_.layout.size;
    }
    [[nodiscard]] constexpr bool writes(DataOffset at) const noexcept {
        return at == no_data || (at >= tables_.layout.constants && at < tables_.layout.size);
    }
    [[nodiscard]] constexpr bool leads(NodeIndex to) const noexcept {
        return to == no_node || to == end_node || to < tables_.nodes.size();
    }
    /// An instruction that is never executed has no function.
    [[nodiscard]] constexpr bool runs(std::size_t first, std::size_t count) const noexcept {
        if (!fits(first, count, tables_.instructions.size())) return false;
        for (std::size_t i = first; i < first + count; ++i)
            if (tables_.instructions[i].run == nullptr) return false;
        return true;
    }
    [[nodiscard]] constexpr bool is_good(const Instruction& in) const noexcept {
        const bool linked = in.facet == nullptr || in.link < tables_.links.size();
        return linked && writes(in.to) && reads(in.a) && reads(in.b);
    }
    [[nodiscard]] constexpr bool is_good(const ConditionRow& row) const noexcept {
        return runs(row.first, row.count) && row.result < tables_.layout.size;
    }
    [[nodiscard]] constexpr bool is_good(const ArcRow& row) const noexcept {
        return (row.condition == no_condition || row.condition < tables_.conditions.size()) &&
               leads(row.to) && (row.after == no_data || fits(row.after, sizeof(Duration), kept()));
    }
    /// Bytes that are kept between steps.
    [[nodiscard]] constexpr std::size_t kept() const noexcept { return tables_.layout.arguments; }
    [[nodiscard]] constexpr bool is_good(const NodeRow& row) const noexcept {
        return runs(row.first, row.count) && fits(row.first_arc, row.arcs, tables_.arcs.size()) &&
               leads(row.on_error);
    }
    [[nodiscard]] constexpr bool is_good(const ProgramRow& row) const noexcept {
        return leads(row.first) && row.first != no_node &&
               (row.first == end_node || (row.first <= row.last && row.last <= tables_.nodes.size()));
    }
    [[nodiscard]] constexpr bool is_good(const VariableRow& row) const noexcept {
        return row.type != nullptr && fits(row.at, row.type->size, tables_.layout.size);
    }

    const ProgramTables& tables_;
};

} // namespace detail

/// Returns empty when every number in the tables is valid. Bounded by their rows; also on the target.
constexpr Sentence check_tables(const ProgramTables& tables) { return detail::TableCheck{tables}.check(); }

} // namespace tappet

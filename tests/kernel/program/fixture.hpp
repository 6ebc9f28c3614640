// Fixture of program tests: a component with one facet of every kind, and a table that is filled row by row.
#pragma once

#include "kernel/program/execution.hpp"
#include "kernel/program/operators.hpp"

#include <array>
#include <cstring>
#include <string>
#include <vector>

namespace program_test {

using namespace tappet;

constexpr Time at_ms(std::int64_t ms) { return at_ns(ms * 1'000'000); }

/// A program built row by row; offsets are multiples of 16.
class TableBuilder {
public:
    explicit TableBuilder(std::size_t constants = 0) : constants_{constants} {}

    template <class T>
    DataOffset value(const T& initial) {
        const auto at = static_cast<DataOffset>(image_.size());
        image_.resize(image_.size() + (sizeof(T) + 15) / 16 * 16);
        std::memcpy(image_.data() + at, static_cast<const void*>(&initial), sizeof(T));
        return at;
    }
    DataOffset scratch(std::size_t bytes = 16) {
        const auto at = static_cast<DataOffset>(scratch_);
        scratch_ += (bytes + 15) / 16 * 16;
        return at;
    }
    static Instruction with(Instruction in, DataOffset to, DataOffset a = no_data, DataOffset b = no_data,
                            std::uint16_t link = 0) {
        in.to = to, in.a = a, in.b = b, in.link = link;
        return in;
    }
    std::uint16_t instructions(std::initializer_list<Instruction> list) {
        const auto first = static_cast<std::uint16_t>(instructions_.size());
        instructions_.insert(instructions_.end(), list);
        return first;
    }
    ConditionIndex condition(std::initializer_list<Instruction> list, DataOffset result) {
        conditions_.push_back({instructions(list), static_cast<std::uint16_t>(list.size()), result});
        return static_cast<ConditionIndex>(conditions_.size() - 1);
    }
    /// Its arcs are added by the following arc() calls.
    TableBuilder& node(std::initializer_list<Instruction> list, NodeIndex on_error = no_node) {
        NodeRow row;
        row.first = instructions(list);
        row.count = static_cast<std::uint16_t>(list.size());
        row.first_arc = static_cast<std::uint16_t>(arcs_.size());
        row.on_error = on_error;
        row.line = static_cast<std::uint16_t>(nodes_.size() + 1);
        nodes_.push_back(row);
        return *this;
    }
    TableBuilder& arc(NodeIndex to, ConditionIndex condition = no_condition, DataOffset after = no_data) {
        arcs_.push_back({condition, to, after});
        ++nodes_.back().arcs;
        return *this;
    }
    NodeRow& last() { return nodes_.back(); }

    /// A view of this builder, which must not move.
    const ProgramTables& tables() {
        program_ = {"test", 0, static_cast<NodeIndex>(nodes_.size()), true};
        tables_ = {instructions_, conditions_, nodes_, arcs_, {&program_, 1}, {}, {}, image_, {}};
        tables_.layout.constants = static_cast<DataOffset>(constants_);
        tables_.layout.variables = static_cast<DataOffset>(image_.size());
        tables_.layout.arguments = tables_.layout.variables;
        tables_.layout.size = static_cast<DataOffset>(scratch_);
        return tables_;
    }

private:
    static constexpr std::size_t scratch_from = 1024; // after all values
    std::size_t constants_;
    std::size_t scratch_ = scratch_from;
    std::vector<Instruction> instructions_;
    std::vector<ConditionRow> conditions_;
    std::vector<NodeRow> nodes_;
    std::vector<ArcRow> arcs_;
    std::vector<std::byte> image_;
    ProgramRow program_;
    ProgramTables tables_;
};

/// An executing program of such a table.
struct Running {
    alignas(data_alignment) std::array<std::byte, 4096> data{};
    std::vector<ProgramLink> links{};
    ProgramExecution execution{};

    Running(TableBuilder& builder, const ProgramPolicy& policy = {}, void* component = nullptr,
            std::vector<ProgramLink> to = {})
        : links{std::move(to)} {
        ProgramContext context;
        context.component = component;
        context.data = data.data();
        context.links = links.data();
        const ProgramTables& tables = builder.tables();
        execution.bind(interpreted(tables), context, tables.image, policy);
    }
    template <class T>
    T get(DataOffset at) const {
        T value;
        std::memcpy(static_cast<void*>(&value), data.data() + at, sizeof value);
        return value;
    }
    template <class T>
    void put(DataOffset at, const T& value) {
        std::memcpy(data.data() + at, static_cast<const void*>(&value), sizeof value);
    }
    /// Starts it and makes one step.
    ProgramStatus run(Time now = at_ns(0)) {
        static_cast<void>(execution.start());
        execution.step(now);
        return execution.status();
    }
    ProgramStatus step(Time now) {
        execution.step(now);
        return execution.status();
    }
};

inline Instruction increment(DataOffset value, DataOffset one) {
    return TableBuilder::with(find_binary(Operator::add, script_int, script_int).instruction, value, value,
                              one);
}

} // namespace program_test

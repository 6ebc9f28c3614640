// Programs decoded from their flat form: the instructions of a node or condition as the text of a script, and
// the part that a model of Boolean and enumeration variables can follow.
#pragma once

#include "toolchain/tools/chart/chart.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace tappet::chart {

/// An expression. `model` is empty when its value depends on what no model keeps: numbers, times, ports.
struct Expression {
    std::string text;
    std::string model;
};

struct Statement {
    enum class Kind : std::uint8_t {
        assign, ///< a variable of the machine
        emit,   ///< an event
        act,    ///< any other action on a component
        fail    ///< the action fails
    };
    Kind kind = Kind::act;
    std::string text;
    DataOffset at = no_data; ///< of the variable
    std::string event;       ///< "component.event"
    Expression value;        ///< of the assignment
    bool may_fail = false;
    bool only_sometimes = false; ///< depends on a condition inside the node
};

struct Node {
    std::vector<Statement> statements;
    bool may_fail = false;
    /// Returns the statements, one per line; empty: it only waits.
    [[nodiscard]] std::string text() const;
};

/// Reads the programs of a chart that has programs.
class ProgramText {
public:
    explicit ProgramText(const Chart& chart) : chart_{chart}, tables_{*chart.programs} {}

    [[nodiscard]] Node node(NodeIndex number) const;
    [[nodiscard]] std::string condition(ConditionIndex number) const { return expression(number).text; }
    [[nodiscard]] Expression expression(ConditionIndex number) const;
    /// Returns a variable's name, or "#offset" when there is no variable.
    [[nodiscard]] std::string variable(DataOffset at) const;
    /// A whole program on one line: its nodes' actions, in their order; or its name if that is too long.
    [[nodiscard]] std::string program(ProgramIndex number) const;
    /// Returns the variable if a model can keep it (Boolean or enumeration); otherwise null.
    [[nodiscard]] const VariableRow* kept(DataOffset at) const;
    /// Returns its initial value; below: its name in a model.
    [[nodiscard]] unsigned initial_value(const VariableRow& row) const;
    [[nodiscard]] static std::string model_name(const Chart& chart, const VariableRow& row);

private:
    using Values = std::map<DataOffset, Expression>;
    struct Reading {
        Values values;
        std::vector<Statement> statements;
        bool may_fail = false;
    };
    void read(std::size_t first, std::size_t count, Reading& reading) const;
    /// Reads an instruction that only computes; returns false when it has an effect.
    [[nodiscard]] bool read_expression(const Instruction& in, Reading& reading) const;
    void read_one(const Instruction& in, Reading& reading) const;
    void give(const Instruction& in, Expression value, Reading& reading) const;
    [[nodiscard]] Expression value(DataOffset at, TypeId type, const Reading& reading) const;
    [[nodiscard]] Expression constant(DataOffset at, TypeId type) const;
    [[nodiscard]] std::string place(const Instruction& in) const;
    [[nodiscard]] std::string arguments(const Instruction& in, const Reading& reading) const;
    [[nodiscard]] const VariableRow* row_at(DataOffset at) const;
    [[nodiscard]] std::span<const std::byte> image() const {
        return chart_.image.empty() ? tables_.image : chart_.image;
    }

    const Chart& chart_;
    const ProgramTables& tables_;
};

} // namespace tappet::chart

// Executes the instructions of a node with texts in place of values.
#include "toolchain/tools/chart/program_text.hpp"

#include "kernel/base/value_text.hpp"
#include "kernel/program/beside.hpp"
#include "kernel/program/operators.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>

namespace tappet::chart {

namespace {

/// Spelled as in a script, with its effect on a model's variables.
struct Word {
    std::string_view text;
    std::string_view model{}; ///< in Promela; empty: no model follows it
    TypeId a = nullptr;
    TypeId b = nullptr;
};

const Word* binary_word(Primitive run) {
    static const auto words = [] {
        std::map<Primitive, Word> all;
        for (const detail::BinaryRow& row : detail::binary_rows) {
            Word word{to_text(row.op), {}, row.a, row.b};
            if (row.a == script_bool && row.b == script_bool) word.model = word.text;
            all.emplace(row.run, word);
        }
        return all;
    }();
    const auto found = words.find(run);
    return found == words.end() ? nullptr : &found->second;
}

const Word* unary_word(Primitive run) {
    static const auto words = [] {
        std::map<Primitive, Word> all;
        for (const detail::UnaryRow& row : detail::unary_rows) {
            Word word{to_text(row.op), {}, row.a, nullptr};
            if (row.op == Operator::invert) word.model = "!";
            all.emplace(row.run, word);
        }
        return all;
    }();
    const auto found = words.find(run);
    return found == words.end() ? nullptr : &found->second;
}

const detail::FunctionRow* function_word(Primitive run) {
    const auto* const found = std::ranges::find(detail::function_rows, run, &detail::FunctionRow::run);
    return found == std::end(detail::function_rows) ? nullptr : found;
}

bool is_conversion(Primitive run) {
    return std::ranges::find(detail::conversion_rows, run, &detail::ConversionRow::run) !=
               std::end(detail::conversion_rows) ||
           std::ranges::find(detail::widenings, run) != std::end(detail::widenings) ||
           std::ranges::find(detail::narrowings, run) != std::end(detail::narrowings);
}

Expression unknown(std::string text) { return {std::move(text), {}}; }

} // namespace

std::string Node::text() const {
    std::string text;
    for (const Statement& each : statements) text += (text.empty() ? "" : "; ") + each.text;
    return text;
}

const VariableRow* ProgramText::row_at(DataOffset at) const {
    const auto found = std::ranges::find(tables_.variables, at, &VariableRow::at);
    return found == tables_.variables.end() ? nullptr : &*found;
}

std::string ProgramText::variable(DataOffset at) const {
    const VariableRow* const row = row_at(at);
    return row != nullptr ? std::string{row->name} : "#" + std::to_string(at);
}

const VariableRow* ProgramText::kept(DataOffset at) const {
    const VariableRow* const row = row_at(at);
    if (row == nullptr || row->kind == VariableKind::argument) return nullptr;
    return row->type == type_id<bool> || !row->type->names.empty() ? row : nullptr;
}

unsigned ProgramText::initial_value(const VariableRow& row) const {
    if (row.at >= image().size()) return 0;
    return static_cast<unsigned>(std::to_integer<unsigned char>(image()[row.at]));
}

std::string ProgramText::model_name(const Chart& chart, const VariableRow& row) {
    return identifier(chart.name) + "_v_" + identifier(row.name);
}

Expression ProgramText::constant(DataOffset at, TypeId type) const {
    if (type == nullptr || at + type->size > image().size()) return unknown("?");
    if (type == type_id<Duration>) {
        Duration time{};
        std::memcpy(&time, image().data() + at, sizeof time);
        return unknown(time_text(time));
    }
    std::array<char, 120> characters{};
    const std::string text{characters.data(),
                           std::min(characters.size(), format_value(*type, image().data() + at, characters))};
    if (type == type_id<bool> || !type->names.empty())
        return {text, std::to_string(std::to_integer<unsigned>(image()[at]))};
    return unknown(text);
}

Expression ProgramText::value(DataOffset at, TypeId type, const Reading& reading) const {
    if (const auto found = reading.values.find(at); found != reading.values.end()) return found->second;
    if (const VariableRow* const row = row_at(at)) {
        Expression found{std::string{row->name}, {}};
        if (kept(at) != nullptr) found.model = model_name(chart_, *row);
        return found;
    }
    if (at < tables_.layout.constants) return constant(at, type);
    return unknown("#" + std::to_string(at));
}

std::string ProgramText::place(const Instruction& in) const {
    std::string component;
    if (in.link < tables_.links.size()) {
        const std::uint16_t peer = tables_.links[in.link].peer;
        if (peer != 0 && peer < chart_.reach.size()) component = std::string{chart_.reach[peer].name} + ".";
    }
    return component + std::string{in.facet != nullptr ? in.facet->name : "?"};
}

std::string ProgramText::arguments(const Instruction& in, const Reading& reading) const {
    const bool is_command = in.facet->kind == FacetKind::command;
    const TypeId list = is_command ? in.facet->command->arguments : in.facet->type;
    std::string text = "(";
    DataOffset at = is_command && in.run == &primitive::begin_command ? in.to : in.a;
    if (list != nullptr)
        for (std::size_t i = 0; i < list->elements.size(); ++i) {
            text += (i == 0 ? "" : ", ") + value(at, list->elements[i], reading).text;
            at = static_cast<DataOffset>(at + list->elements[i]->size);
        }
    return text + ")";
}

void ProgramText::give(const Instruction& in, Expression value, Reading& reading) const {
    if (const VariableRow* const row = row_at(in.to)) {
        Statement done;
        done.kind = Statement::Kind::assign;
        done.text = std::string{row->name} + " = " + value.text;
        done.at = in.to;
        done.value = value;
        reading.statements.push_back(std::move(done));
    }
    reading.values[in.to] = std::move(value);
}

bool ProgramText::read_expression(const Instruction& in, Reading& reading) const {
    namespace p = primitive;
    if (const Word* const word = binary_word(in.run)) {
        const Expression a = value(in.a, word->a, reading);
        const Expression b = value(in.b, word->b, reading);
        Expression sum{"(" + a.text + " " + std::string{word->text} + " " + b.text + ")", {}};
        if (!word->model.empty() && !a.model.empty() && !b.model.empty())
            sum.model = "(" + a.model + " " + std::string{word->model} + " " + b.model + ")";
        give(in, std::move(sum), reading);
    } else if (const Word* const one = unary_word(in.run)) {
        const Expression a = value(in.a, one->a, reading);
        Expression sum{std::string{one->text} + a.text, {}};
        if (!one->model.empty() && !a.model.empty()) sum.model = std::string{one->model} + a.model;
        give(in, std::move(sum), reading);
    } else if (const detail::FunctionRow* const function = function_word(in.run)) {
        std::string text = std::string{function->name} + "(" + value(in.a, function->a, reading).text;
        if (function->b != nullptr) text += ", " + value(in.b, function->b, reading).text;
        give(in, unknown(text + ")"), reading);
    } else if (in.run == p::bytes_equal || in.run == p::bytes_unequal) {
        // One of two compared enumerations has a known type (variable or value); the other has the same.
        const VariableRow* const a_row = row_at(in.a);
        const VariableRow* const b_row = row_at(in.b);
        const TypeId type = a_row != nullptr ? a_row->type : b_row != nullptr ? b_row->type : nullptr;
        const Expression a = value(in.a, type, reading);
        const Expression b = value(in.b, type, reading);
        const char* const sign = in.run == p::bytes_equal ? " == " : " != ";
        Expression sum{"(" + a.text + sign + b.text + ")", {}};
        if (!a.model.empty() && !b.model.empty()) sum.model = "(" + a.model + sign + b.model + ")";
        give(in, std::move(sum), reading);
    } else if (in.run == &p::copy || in.run == &p::text_copy || is_conversion(in.run)) {
        const VariableRow* const row = row_at(in.to);
        const TypeId by_size = in.size == sizeof(bool) ? script_bool : in.size == 8 ? script_int : nullptr;
        Expression from = value(in.a, row != nullptr ? row->type : by_size, reading);
        if (row == nullptr && in.size == 8) from.model.clear();
        give(in, std::move(from), reading);
    } else if (in.run == &p::field_read) {
        give(in, unknown(value(in.a, nullptr, reading).text + "." + std::string{in.field->name}), reading);
    } else if (in.run == &p::element_read) {
        give(in,
             unknown(value(in.a, nullptr, reading).text + "[" + value(in.b, script_int, reading).text + "]"),
             reading);
    } else {
        return false;
    }
    return true;
}

void ProgramText::read_one(const Instruction& in, Reading& reading) const {
    namespace p = primitive;
    const auto does = [&](Statement::Kind kind, const std::string& text, bool may_fail) {
        Statement done;
        done.kind = kind;
        done.text = text;
        done.may_fail = may_fail;
        if (kind == Statement::Kind::emit) done.event = place(in);
        reading.may_fail = reading.may_fail || may_fail;
        reading.statements.push_back(std::move(done));
    };
    if (read_expression(in, reading)) return;
    if (in.run == &p::field_write) {
        does(Statement::Kind::act,
             variable(in.to) + "." + std::string{in.field->name} + " = " +
                 value(in.a, in.field->type, reading).text,
             false);
    } else if (in.run == &p::element_write) {
        does(Statement::Kind::act,
             variable(in.to) + "[" + value(in.b, script_int, reading).text +
                 "] = " + value(in.a, nullptr, reading).text,
             true);
    } else if (in.run == &p::fail) {
        does(Statement::Kind::fail, "fail", true);
    } else if (in.run == &p::read_input || in.run == &p::read_output || in.run == &p::read_property) {
        give(in, unknown(place(in)), reading);
    } else if (in.run == &p::write_output || in.run == &p::write_property || in.run == &p::push_all) {
        does(Statement::Kind::act, place(in) + " = " + value(in.a, in.facet->type, reading).text,
             in.run != &p::write_output);
    } else if (in.run == &p::emit_event) {
        does(Statement::Kind::emit, place(in) + arguments(in, reading), false);
    } else if (in.run == &p::call_operation) {
        does(Statement::Kind::act, place(in) + arguments(in, reading), false);
    } else if (in.run == &p::call_method) {
        give(in, unknown(place(in) + arguments(in, reading)), reading);
        if (in.to == no_data) does(Statement::Kind::act, place(in) + arguments(in, reading), false);
    } else if (in.run == &p::call_checked) {
        does(Statement::Kind::act, place(in) + arguments(in, reading), true);
    } else if (in.run == &p::begin_command || in.run == &p::send_command) {
        does(Statement::Kind::act, place(in) + arguments(in, reading), true);
    } else if (in.run == &p::begin_program) {
        does(Statement::Kind::act, "program " + std::to_string(in.rows), true);
    } else if (in.run == &p::command_progress || in.run == &p::command_ended || in.run == &p::program_ended) {
        reading.may_fail = true;
        give(in, unknown("done"), reading);
    } else if (in.run == &p::elapsed) {
        give(in, unknown("elapsed"), reading);
    } else if (in.run == &p::time_now) {
        give(in, unknown("now"), reading);
    } else if (in.facet != nullptr) {
        give(in, unknown(place(in)), reading);
        reading.may_fail = true;
    } else {
        std::string text = "(" + value(in.a, nullptr, reading).text;
        if (in.b != no_data) text += ", " + value(in.b, nullptr, reading).text;
        give(in, unknown("..." + text + ")"), reading);
    }
}

// Reads a skipped part with the values before it. Afterwards a && b and a || b are recombined, and other
// skipped statements are marked as done only sometimes.
void ProgramText::read(std::size_t first, std::size_t count, Reading& reading) const {
    for (std::size_t i = 0; i < count; ++i) {
        const Instruction& in = tables_.instructions[first + i];
        const bool unless = in.run == &primitive::skip_unless;
        if (!unless && in.run != &primitive::skip_if) {
            read_one(in, reading);
            continue;
        }
        const std::size_t left_out = std::min<std::size_t>(in.size, count - i - 1);
        const Expression decides = value(in.a, script_bool, reading);
        Reading taken = reading;
        taken.statements.clear();
        read(first + i + 1, left_out, taken);
        const char* const sign = unless ? " && " : " || ";
        for (const auto& [at, then] : taken.values) {
            const auto before = reading.values.find(at);
            if (before != reading.values.end() && before->second.text == then.text) continue;
            if (at == in.a || (before != reading.values.end() && before->second.text == decides.text)) {
                Expression both{"(" + decides.text + sign + then.text + ")", {}};
                if (!decides.model.empty() && !then.model.empty())
                    both.model = "(" + decides.model + sign + then.model + ")";
                reading.values[at] = std::move(both);
            } else if (before == reading.values.end()) {
                reading.values[at] = then; // scratch of the skipped part
            } else {
                reading.values[at] = unknown("(" + decides.text + " ? ...)");
            }
        }
        for (Statement& each : taken.statements) {
            each.text = (unless ? "if " : "unless ") + decides.text + ": " + each.text;
            each.only_sometimes = true;
            reading.statements.push_back(std::move(each));
        }
        reading.may_fail = reading.may_fail || taken.may_fail;
        i += left_out;
    }
}

Node ProgramText::node(NodeIndex number) const {
    Reading reading;
    const NodeRow& row = tables_.nodes[number];
    read(row.first, row.count, reading);
    return {std::move(reading.statements), reading.may_fail};
}

Expression ProgramText::expression(ConditionIndex number) const {
    const ConditionRow& row = tables_.conditions[number];
    Reading reading;
    read(row.first, row.count, reading);
    Expression found = value(row.result, script_bool, reading);
    if (found.text.size() > 2 && found.text.front() == '(' && found.text.back() == ')')
        found.text = found.text.substr(1, found.text.size() - 2);
    return found;
}

std::string ProgramText::program(ProgramIndex number) const {
    static constexpr std::size_t longest = 60;
    const ProgramRow& row = tables_.programs[number];
    std::string text;
    for (std::size_t n = row.first; n < row.last && n < tables_.nodes.size(); ++n) {
        const std::string one = node(static_cast<NodeIndex>(n)).text();
        if (!one.empty()) text += (text.empty() ? "" : "; ") + one;
    }
    return text.size() <= longest && !text.empty() ? text : std::string{row.name};
}

} // namespace tappet::chart

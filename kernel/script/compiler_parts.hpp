// Parts of values and composed values: fields, elements, constructors, functions of the library.
#pragma once

#include "kernel/script/compiler_expressions.hpp"

namespace tappet::script_detail {

constexpr Operand Expressions::take_part(const Operand& whole) {
    const Token at = token_;
    if (whole.literal) {
        fail(at, {"a ", type_name(whole.type), " has no parts"});
        return {};
    }
    if (is(Sign::open_square)) return take_element(whole);
    advance();
    const Token name = need_word("the name of a field");
    if (!ok()) return {};
    const TypeId type = whole.type;
    if (type->kind == ValueKind::record) {
        for (const RecordField& field : type->fields)
            if (field.name == name.text) return part_of(whole, field.type, field.offset());
        Nearest nearest{name.text};
        for (const RecordField& field : type->fields) nearest.consider(field.name);
        fail_unknown(name, "field", nearest, " in the record");
        return {};
    }
    if (type->kind == ValueKind::matrix && type->columns == 1 && name.text.size() == 1) {
        const std::size_t i = name.text[0] == 'w' ? 3 : static_cast<std::size_t>(name.text[0] - 'x');
        if (name.text[0] >= 'w' && name.text[0] <= 'z' && i < type->rows)
            return part_of(whole, type->element, i * type->element->size);
    }
    fail(name, {"a ", type_name(type), " has no \"", quoted(name.text),
                "\"; fields are those of records, and x, y, z of vectors"});
    return {};
}

constexpr Operand Expressions::take_element(const Operand& whole) {
    const Token at = token_;
    const Index index = parse_index(whole.type);
    if (!ok()) return {};
    const TypeId element = whole.type->element;
    if (index.is_known) return part_of(whole, element, index.number * element->size);
    Instruction in = element_read(whole.type);
    if (in.run == nullptr) {
        fail(at, {"a ", type_name(whole.type), " has no elements"});
        return {};
    }
    in.to = scratch(element->size);
    in.a = whole.at;
    in.b = index.at;
    emit(in);
    return made(element, in.to);
}

constexpr Expressions::Index Expressions::parse_index(TypeId type) {
    Index index;
    const Token at = token_;
    if (!need(Sign::open_square, "\"[\"")) return index;
    if (type->kind != ValueKind::matrix && type->kind != ValueKind::sequence) {
        fail(at, {"a ", type_name(type), " has no elements"});
        return index;
    }
    const bool is_matrix = type->kind == ValueKind::matrix && type->rows > 1 && type->columns > 1;
    const std::size_t rows = is_matrix                         ? type->rows
                             : type->kind == ValueKind::matrix ? type->rows * type->columns
                                                               : type->columns;
    const Operand row = parse_subscript(rows);
    if (!is_matrix) {
        need(Sign::close_square, "\"]\"");
        if (!ok()) return index;
        index.is_known = row.literal && type->kind == ValueKind::matrix;
        index.number = static_cast<std::size_t>(row.integer);
        if (!index.is_known) index.at = in_data(at, row).at;
        return index;
    }
    if (!take(Sign::comma)) {
        need(Sign::close_square, "\"]\"");
        need(Sign::open_square, "\"[\" and the column");
    }
    const Operand column = parse_subscript(type->columns);
    need(Sign::close_square, "\"]\"");
    if (!ok()) return index;
    if (row.literal && column.literal) {
        const auto r = static_cast<std::size_t>(row.integer), c = static_cast<std::size_t>(column.integer);
        index.is_known = true;
        index.number = type->row_major ? r * type->columns + c : c * type->rows + r;
        return index;
    }
    Instruction in = matrix_index(type);
    in.to = scratch(sizeof(ScriptInt));
    in.a = in_data(at, row).at;
    in.b = in_data(at, column).at;
    emit(in);
    index.at = in.to;
    return index;
}

constexpr Operand Expressions::parse_subscript(std::size_t size) {
    const Token at = token_;
    const Operand value = reckoned(at, parse_expression(script_int));
    if (!ok()) return {};
    if (value.type != script_int)
        fail_type(at, value.type, "an int", " as an index");
    else if (value.literal && (value.integer < 0 || value.integer >= static_cast<std::int64_t>(size)))
        fail(at,
             {"found an index out of range; elements are counted from 0 on, and there are ", digits(size)});
    return value;
}

constexpr Operand Expressions::parse_function(const Token& name) {
    if (name.text == "time" || name.text == "elapsed") {
        advance();
        if (!need(Sign::close_round, "\")\"")) return {};
        const FacetAction action = name.text == "time" ? machine_time() : elapsed_time();
        Instruction in = action.instruction;
        in.to = scratch(sizeof(Duration));
        emit(in);
        return made(action.type, in.to);
    }
    if (const TypeId type = find_type(name.text); type != nullptr) return parse_constructor(name, type);
    advance();
    Operand operands[2];
    TypeId types[2] = {};
    std::size_t count = 0;
    while (ok() && !is(Sign::close_round)) {
        if (count == 2) {
            fail(token_, {"\"", quoted(name.text), "\" has at most 2 arguments"});
            return {};
        }
        const Token at = token_;
        operands[count] = reckoned(at, parse_expression());
        types[count] = operands[count].type;
        ++count;
        if (!is(Sign::close_round) && !need(Sign::comma, "\",\" or \")\"")) return {};
    }
    if (!ok() || !need(Sign::close_round, "\")\"")) return {};
    const OperatorMatch match = find_function(name.text, std::span{types}.first(count));
    if (!match) {
        fail_function(name, types[0], count > 1 ? types[1] : nullptr);
        return {};
    }
    const Operand a = as(name, operands[0], match.a, "");
    const Operand b = match.b != nullptr ? as(name, operands[1], match.b, "") : Operand{};
    return apply(match, a, b);
}

constexpr void Expressions::fail_function(const Token& name, TypeId first, TypeId second) {
    Nearest nearest{name.text};
    bool is_known = false;
    for (const std::string_view each : function_names()) {
        is_known = is_known || each == name.text;
        nearest.consider(each);
    }
    for (std::size_t i = 0; i < functions_used_; ++i) nearest.consider(functions_[i].name);
    for (const Facet& each : facets(0))
        if (each.kind == FacetKind::method) nearest.consider(each.name);
    if (is_known)
        fail(name, {"there is no ", name.text, "(", type_name(first), second != nullptr ? ", " : "",
                    second != nullptr ? type_name(second) : "", ")"});
    else
        fail_unknown(name, "function", nearest, "");
}

constexpr Operand Expressions::parse_constructor(const Token& name, TypeId type) {
    advance();
    const bool is_record = type->kind == ValueKind::record, is_matrix = type->kind == ValueKind::matrix;
    if (!is_record && !is_matrix) {
        const Token at = token_;
        const Operand value = reckoned(at, parse_expression());
        if (!need(Sign::close_round, "\")\"")) return {};
        if (value.literal && value.type == script_int && type == script_double)
            return literal_of(script_double, 0, value.real);
        if (value.type == type) return value;
        const Conversion conversion = find_conversion(value.type, type);
        if (!conversion) {
            fail_type(at, value.type, type_name(type), "");
            return {};
        }
        const Operand ready = in_data(at, value);
        return ok() ? convert(conversion, ready, type, scratch(type->size)) : Operand{};
    }
    // Its known parts are among the constants; the others are written into a copy of them.
    Operand whole = at_place(type, no_data);
    static_cast<void>(add_constant(type->size, whole.at));
    whole.constant = true;
    const std::size_t parts = is_record ? type->fields.size() : type->rows * type->columns;
    for (std::size_t i = 0; ok() && i < parts; ++i) {
        if (i != 0 && !need(Sign::comma, "\",\" and a value for each part")) return {};
        const TypeId part = is_record ? type->fields[i].type : type->element;
        // A matrix literal is written row by row.
        const std::size_t offset =
            is_record ? type->fields[i].offset()
                      : type->element->size *
                            (type->row_major ? i : (i % type->columns) * type->rows + i / type->columns);
        const Token at = token_;
        const Operand value = parse_expression(part);
        if (!ok()) return {};
        if (whole.constant && value.literal) {
            std::byte bytes[8] = {};
            std::byte* const into = room_.image.data() + image_base_ + within(whole.at) + offset;
            if (part->size <= 8 ? !encode(value, part, bytes) : !encode(value, part, into)) {
                fail_type(at, value.type, type_name(part), "");
                return {};
            }
            if (part->size <= 8) std::copy_n(bytes, part->size, into);
            continue;
        }
        if (whole.constant) {
            Instruction in = copy_instruction(type);
            in.a = whole.at;
            in.to = whole.at = scratch(type->size);
            whole.constant = false;
            // The instruction just before may have made the value.
            Operand kept = value;
            kept.simple = false;
            emit(in);
            store(at, kept, part, moved(whole.at, offset), "");
            continue;
        }
        store(at, value, part, moved(whole.at, offset), "");
    }
    if (!ok()) return {};
    if (is(Sign::comma)) {
        fail(token_, {"a ", type_name(type), " has ", digits(parts), " parts; leave out what is more"});
        return {};
    }
    static_cast<void>(name);
    need(Sign::close_round, "\")\"");
    return whole;
}

} // namespace tappet::script_detail

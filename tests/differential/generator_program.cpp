// Expressions and statements of generated scripts.
#include "tests/differential/generator.hpp"

#include <array>

namespace tappet {

std::string_view Generator::type_of(Kind kind) {
    switch (kind) {
    case Kind::integer: return "int";
    case Kind::real: return "double";
    case Kind::boolean: return "bool";
    case Kind::time: return "Duration";
    case Kind::vector: return "vector3";
    case Kind::record: return "Place";
    case Kind::text: return "text";
    }
    return "?";
}

const Generator::Named* Generator::variable(Kind kind, bool to_write) {
    std::vector<const Named*> fitting;
    for (const Named& each : names_)
        if (each.kind == kind && (each.writable || !to_write)) fitting.push_back(&each);
    return fitting.empty() ? nullptr : any(fitting);
}

std::string Generator::literal(Kind kind) {
    static constexpr std::array<std::string_view, 6> wholes = {"0", "1", "2", "3", "100", "40000"};
    static constexpr std::array<std::string_view, 5> reals = {"0.5", "2.0", "1.25e2", "0.1", "3.75"};
    static constexpr std::array<std::string_view, 5> texts = {"", "a", "abc", "eight ch", "nine char"};
    static constexpr std::array<std::string_view, 4> times = {"10ms", "25ms", "1s", "1500us"};
    switch (kind) {
    case Kind::integer: return one_in(60) ? "9223372036854775807" : std::string{any(wholes)};
    case Kind::real: return std::string{any(reals)};
    case Kind::boolean: return one_in(2) ? "true" : "false";
    case Kind::time: return std::string{any(times)};
    case Kind::text: return "\"" + std::string{any(texts)} + "\"";
    case Kind::vector:
    case Kind::record: return {};
    }
    return {};
}

std::string Generator::expression(Kind kind, int depth) {
    const Named* named = variable(kind, false);
    if (named != nullptr && (depth == 0 || one_in(3))) return named->name;
    if (depth == 0 && kind != Kind::vector) return literal(kind);
    switch (kind) {
    case Kind::integer: return whole(depth - 1);
    case Kind::real: return real(depth - 1);
    case Kind::boolean: return truth(depth - 1);
    case Kind::time: return time(depth - 1);
    case Kind::vector: return vector(depth - 1);
    case Kind::record:
    case Kind::text: break;
    }
    return {};
}

std::string Generator::whole(int depth) {
    const std::string a = expression(Kind::integer, depth);
    switch (below(12)) {
    case 10:
        if (const Named* place = variable(Kind::record, false)) return place->name + ".turns";
        return literal(Kind::integer);
    case 11:
        if (has_value_functions_ && !in_child_ && !in_function_) return "half(" + a + ")";
        return literal(Kind::integer);
    case 0: return "(" + a + " + " + expression(Kind::integer, depth) + ")";
    case 1: return "(" + a + " - " + expression(Kind::integer, depth) + ")";
    case 2: return "(" + a + " * " + expression(Kind::integer, depth) + ")";
    case 3:
        return "(" + a + (one_in(2) ? " / " : " % ") + (one_in(4) ? expression(Kind::integer, depth) : "3") +
               ")";
    case 4: return "(-" + a + ")";
    case 5: return (one_in(2) ? "abs(" : "max(3, ") + a + ")";
    case 6: return "min(" + a + ", " + expression(Kind::integer, depth) + ")";
    case 7: return "gain";
    case 8: return std::string{one_in(2) ? "note(" : "mate.note("} + a + ")";
    default: return literal(Kind::integer);
    }
}

std::string Generator::real(int depth) {
    const std::string a = expression(Kind::real, depth);
    switch (below(12)) {
    case 11:
        if (const Named* place = variable(Kind::record, false)) return place->name + ".x";
        return literal(Kind::real);
    case 0: return a + " + " + expression(Kind::real, depth);
    case 1: return "(" + a + " - " + expression(Kind::real, depth) + ")";
    case 2: return "(" + a + " * " + expression(Kind::integer, depth) + ")";
    case 3: return "(" + a + ") / (" + expression(Kind::real, depth) + ")";
    case 4: return "sqrt(abs(" + a + "))";
    case 5: return "mix(" + a + ", " + std::to_string(below(9)) + ")";
    case 6: return "level";
    case 7: return "measured";
    case 8: return one_in(2) ? "floor(" + a + ")" : "min(" + a + ", " + expression(Kind::real, depth) + ")";
    case 9:
        if (const Named* v = variable(Kind::vector, false))
            return v->name + "[" + (one_in(5) ? "a" : std::to_string(below(3))) + "]";
        return literal(Kind::real);
    default: return literal(Kind::real);
    }
}

std::string Generator::truth(int depth) {
    static constexpr std::array<std::string_view, 6> orders = {" == ", " != ", " < ", " > ", " <= ", " >= "};
    switch (below(10)) {
    case 9: return "queue.empty";
    case 0: return "!" + expression(Kind::boolean, 0);
    case 1: return "(" + expression(Kind::boolean, depth) + " && " + expression(Kind::boolean, depth) + ")";
    case 2: return "(" + expression(Kind::boolean, depth) + " || " + expression(Kind::boolean, depth) + ")";
    case 3:
        return "(" + expression(Kind::real, depth) + std::string{any(orders)} +
               expression(Kind::real, depth) + ")";
    case 4:
        if (has_aid_ && !in_child_ && one_in(3)) return "aid.isRunning()";
        return one_in(2) ? "open" : "mate.open";
    case 5: return std::string{one_in(2) ? "ask(" : "mate.ask("} + std::to_string(below(40)) + ")";
    case 6:
        return "(" + expression(Kind::time, depth) + std::string{any(orders)} +
               expression(Kind::time, depth) + ")";
    default:
        return "(" + expression(Kind::integer, depth) + std::string{any(orders)} +
               expression(Kind::integer, depth) + ")";
    }
}

std::string Generator::time(int depth) {
    const std::string a = expression(Kind::time, depth);
    switch (below(4)) {
    case 0: return "(" + a + " + " + expression(Kind::time, depth) + ")";
    case 1: return "(" + a + " * " + expression(Kind::integer, depth) + ")";
    default: return literal(Kind::time);
    }
}

std::string Generator::vector(int depth) {
    const Named* v = variable(Kind::vector, false);
    switch (below(4)) {
    case 0: return "(" + v->name + " + " + expression(Kind::vector, depth) + ")";
    case 1: return "(" + v->name + " * (" + expression(Kind::real, depth) + "))";
    case 2: return "(" + v->name + " - " + expression(Kind::vector, depth) + ")";
    default: return v->name;
    }
}

// Constant or not: evaluating one is a statement.
std::string Generator::argument() {
    return one_in(3) ? std::to_string(below(9)) : "a % 50 + " + expression(Kind::integer, 1);
}

void Generator::block(int statements, int depth, bool may_wait) {
    const std::size_t kept = names_.size();
    for (int i = 0; i < statements; ++i) statement(depth, may_wait);
    names_.resize(kept); // ends the names that it declared
}

void Generator::statement(int depth, bool may_wait) {
    switch (below(depth > 0 ? 16 : 9)) {
    case 0:
    case 1:
    case 2: return assignment();
    case 3:
    case 4: return call();
    case 5:
    case 6: return may_wait ? waiting(depth) : call();
    case 7: return has_child_ && !in_child_ && !in_function_ ? child_call() : assignment();
    case 8:
        if (!functions_.empty() && !in_function_ && !in_child_)
            return line("do " + any(functions_) + "(" + argument() + ");");
        return assignment();
    case 9:
    case 10:
    case 11:
        open("if " + expression(Kind::boolean, 2) + " then");
        block(1 + static_cast<int>(below(2)), depth - 1, may_wait);
        if (one_in(2)) {
            --depth_, line("} else {"), ++depth_;
            block(1, depth - 1, may_wait);
        }
        return close();
    case 12: return loop(depth, may_wait);
    case 13:
        open("try");
        block(1 + static_cast<int>(below(2)), depth - 1, may_wait);
        --depth_, line("} catch {"), ++depth_;
        block(1, depth - 1, may_wait);
        return close();
    case 14:
        if (one_in(2))
            return line("if " + expression(Kind::boolean, 1) + " then return" +
                        (returns_value_ ? " " + expression(returned_, 1) : "") + ";");
        if (loops_ > 0) return line("if " + expression(Kind::boolean, 1) + " then break;");
        return call();
    default: {
        const Kind kind = one_in(2) ? Kind::integer : Kind::real;
        const std::string name = "local" + std::to_string(++counters_);
        line("var " + std::string{type_of(kind)} + " " + name + " = " + expression(kind, 1) + ";");
        names_.push_back({name, kind});
    }
    }
}

void Generator::waiting(int depth) {
    switch (below(8)) {
    case 0: return line("yield;");
    case 1: return line("wait(" + literal(Kind::time) + ");");
    case 2:
        return line("wait(measured " + std::string{one_in(2) ? "<" : ">"} + " " + std::to_string(below(10)) +
                    ".5);");
    case 3: {
        open("while (measured < " + std::to_string(below(10)) + ".0)");
        ++loops_;
        line("yield;");
        block(1, depth > 0 ? depth - 1 : 0, true);
        --loops_;
        return close();
    }
    default: return command();
    }
}

std::string Generator::goal() {
    if (one_in(12)) return "7";
    if (one_in(12)) return "-1";
    return one_in(6) ? expression(Kind::integer, 1) + " % 5" : std::to_string(below(4));
}

void Generator::command() {
    const std::string limit = one_in(4) ? " timeout " + std::to_string(10 + below(4) * 20) + "ms" : "";
    if (has_aid_ && !in_child_ && !in_function_ && one_in(2))
        return line("do aid(" + expression(Kind::integer, 1) + ", " + expression(Kind::boolean, 1) + ", " +
                    (one_in(2) ? "a" : "b") + ")" + limit + ";");
    switch (below(4)) {
    case 0: return line("do work(" + goal() + ")" + limit + ";");
    case 1:
        return line("do arm.grip(" + expression(Kind::real, 1) + ", " + expression(Kind::boolean, 1) + ")" +
                    limit + ";");
    default: return line("do arm.move(" + goal() + ")" + limit + ";");
    }
}

void Generator::call() {
    if (has_aid_ && !in_child_ && one_in(40)) return line("do aid.stop();");
    switch (below(11)) {
    case 9: return line("do sent.push(" + expression(Kind::real, 1) + ");");
    case 10: {
        const Named* said = variable(Kind::text, false);
        const std::string what = said != nullptr && one_in(2) ? said->name : one_in(2) ? "\"ab\"" : "\"abc\"";
        return line(std::string{one_in(2) ? "do say(" : "do mate.say("} + what + ");");
    }
    case 0: return line("do note(" + expression(Kind::integer, 2) + ");");
    case 1: return line("do mate.note(" + expression(Kind::integer, 1) + ");");
    case 2:
        return line("do mix(" + expression(Kind::real, 1) + ", " + expression(Kind::integer, 1) +
                    " % 1000);");
    case 3: return line("do poke(" + expression(Kind::boolean, 1) + ");");
    case 4: return line("do arm.sum(" + expression(Kind::integer, 1) + ", 4);");
    case 5: return line("do mate.poke(true);");
    case 6: return line("do tick();");
    case 7:
        return line("do moved(" + expression(Kind::integer, 1) + " % 100, " + expression(Kind::real, 1) +
                    ");");
    default: return line("do ask(" + expression(Kind::integer, 1) + " % 100);");
    }
}

void Generator::assignment() {
    static constexpr std::array<Kind, 10> kinds = {Kind::integer, Kind::integer, Kind::integer, Kind::real,
                                                   Kind::real,    Kind::boolean, Kind::boolean, Kind::time,
                                                   Kind::vector,  Kind::real};
    switch (below(16)) {
    case 12:
    case 13:
    case 14: return whole_value();
    case 15:
        if (has_value_functions_ && !in_child_ && !in_function_ && variable(Kind::real, true) != nullptr)
            return line("set " + variable(Kind::real, true)->name + " = pick(" +
                        (one_in(3) ? "0.5" : "y + " + expression(Kind::real, 1)) + ", " + argument() + ");");
        break;
    case 0: return line("set gain = " + expression(Kind::integer, 1) + " % 50;");
    case 1: return line("set level = " + expression(Kind::real, 1) + ";");
    case 2: return line("set setpoint = " + expression(Kind::real, 2) + ";");
    case 3: return line("set mate.open = " + expression(Kind::boolean, 1) + ";");
    default: break;
    }
    const Kind kind = any(kinds);
    const Named* to = variable(kind, true);
    if (to == nullptr) return call();
    if (kind == Kind::vector && !one_in(3))
        return line("set " + to->name + "[" + (one_in(8) ? "(b % 4)" : std::to_string(below(3))) +
                    "] = " + expression(Kind::real, 1) + ";");
    // A real accepts a whole number as well.
    const Kind from = kind == Kind::real && one_in(5) ? Kind::integer : kind;
    line("set " + to->name + " = " + expression(from, 2) + ";");
}

// Assignments of whole values and of their parts, and of elements in order.
void Generator::whole_value() {
    const Named* to = variable(Kind::record, true);
    const Named* text = variable(Kind::text, true);
    if (to == nullptr || text == nullptr) return call();
    const Named* from = variable(Kind::record, false);
    switch (below(8)) {
    case 0: return line("set " + to->name + " = " + from->name + ";");
    case 1: return line("set " + to->name + ".x = " + expression(Kind::real, 1) + ";");
    case 2: return line("set " + to->name + ".turns = b + " + expression(Kind::integer, 1) + ";");
    case 3:
        return line("set " + to->name + " = Place(" + expression(Kind::real, 1) + ", b + " +
                    expression(Kind::integer, 1) + ");");
    case 4:
        return line("set " + to->name + " = " + (one_in(2) ? "mate." : "") + "shift(" + from->name + ", " +
                    expression(Kind::real, 1) + ");");
    case 5: return line("set " + text->name + " = " + literal(Kind::text) + ";");
    case 6: return line("set " + text->name + " = " + variable(Kind::text, false)->name + ";");
    default: return line("set a = queue.pop();");
    }
}

void Generator::loop(int depth, bool may_wait) {
    const std::string i = "i" + std::to_string(++counters_);
    const std::string times = std::to_string(1 + below(4));
    ++loops_;
    if (one_in(2)) {
        open("for (var int " + i + " = 0; " + i + " < " + times + "; set " + i + " = " + i + " + 1)");
        names_.push_back({i, Kind::integer, false});
        block(1 + static_cast<int>(below(2)), depth - 1, may_wait);
    } else {
        line("var int " + i + " = 0;");
        open("while (" + i + " < " + times + ")");
        names_.push_back({i, Kind::integer, false});
        line("set " + i + " = " + i + " + 1;");
        block(1 + static_cast<int>(below(2)), depth - 1, may_wait);
    }
    names_.pop_back();
    --loops_;
    close();
}

void Generator::child_call() {
    static constexpr std::array<std::string_view, 11> calls = {"activate()",
                                                               "activate()",
                                                               "start()",
                                                               "start()",
                                                               "start()",
                                                               "stop()",
                                                               "reset()",
                                                               "requestState(\"B\")",
                                                               "requestState(\"A\")",
                                                               "pause()",
                                                               "deactivate()"};
    if (one_in(4)) return line("set left.load = " + expression(Kind::integer, 1) + ";");
    line("do left." + std::string{any(calls)} + ";");
}

} // namespace tappet

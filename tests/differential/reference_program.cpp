// Walks the statements of a program.
#include "tests/differential/reference_program.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <utility>

namespace tappet::reference {

const Function* Scope::function(const std::string& name) const {
    for (const auto* list : {functions, outer_functions})
        if (list != nullptr)
            for (const Function& each : *list)
                if (each.name == name) return &each;
    return nullptr;
}

Variables* Scope::holder(const std::string& name) {
    if (!given.empty() && given.back()->values.contains(name)) return given.back();
    if (run != nullptr)
        if (Variables* const own = run->holder(name)) return own;
    return values.contains(name) ? this : nullptr;
}

Variables* ProgramRun::holder(const std::string& name) {
    for (std::size_t i = open_.size(); i-- > 0;) {
        if (open_[i].own.values.contains(name)) return &open_[i].own;
        if (open_[i].is_call) break;
    }
    return nullptr;
}

std::map<std::string, std::size_t>& ProgramRun::covered() {
    static std::map<std::string, std::size_t> counts;
    return counts;
}

ProgramRun::Result ProgramRun::run(Scope& scope, std::int64_t now, std::int64_t& statements) {
    struct AtWork {
        Scope& scope;
        ProgramRun* before;
        ~AtWork() { scope.run = before; }
    } const at_work{scope, std::exchange(scope.run, this)};
    while (!open_.empty()) {
        Open& top = open_.back();
        if (catches_) { // reaching it is a statement too
            if (statements == 0) return Result::left_over;
            --statements;
            catches_ = false;
        }
        if (top.next == top.block->size()) {
            const Statement* owner = top.owner;
            const bool is_loop = owner != nullptr && owner->kind == Statement::Kind::loop;
            if (is_loop && !top.is_increment && !owner->second.empty()) {
                top = {.block = &owner->second, .owner = owner, .is_increment = true};
                continue;
            }
            open_.pop_back(); // a loop is at the place where its condition is evaluated again
            if (!is_loop && !open_.empty()) ++open_.back().next;
            continue;
        }
        const Statement& statement = (*top.block)[top.next];
        if (counts(scope, statement) && (!entered_ || again_)) {
            if (statements == 0) {
                ++covered()["statements left over"];
                return Result::left_over;
            }
            --statements;
        }
        if (!entered_) {
            entered_ = true;
            acted_ = false;
            entered_at_ = now;
            line_ = statement.line;
        }
        switch (execute(scope, statement, now)) {
        case Done::next:
            ++open_.back().next;
            entered_ = again_ = false;
            break;
        case Done::elsewhere: entered_ = again_ = false; break;
        case Done::wait: ++covered()["a step ends in a program"]; return Result::waits;
        case Done::failed:
            if (!recover()) return Result::failed;
            entered_ = again_ = false;
            break;
        }
    }
    return Result::ended;
}

// Returns whether it is one of the statements that a step may execute: for a call, the evaluation of its
// arguments is one.
bool ProgramRun::counts(const Scope& scope, const Statement& statement) {
    if (statement.kind != Statement::Kind::perform ||
        scope.function(statement.expressions[0].text) == nullptr)
        return statement.counts;
    return std::ranges::any_of(statement.expressions[0].parts, [](const Expression& argument) {
        return argument.kind != Expression::Kind::literal;
    });
}

// The innermost try around the statement continues with its catch.
bool ProgramRun::recover() {
    for (std::size_t i = open_.size(); i-- > 0;) {
        const Statement* owner = open_[i].owner;
        if (owner == nullptr || owner->kind != Statement::Kind::guarded || open_[i].block == &owner->second)
            continue;
        ++covered()["failure caught"];
        open_.resize(i + 1);
        open_[i] = {.block = &owner->second, .owner = owner};
        catches_ = true;
        return true;
    }
    return false;
}

ProgramRun::Done ProgramRun::set_part(Value& variable, const std::string& name, const Value& value) {
    ++covered()["field of a record"];
    Record& record = std::get<Record>(variable);
    if (name.ends_with(".x")) {
        record.x = std::get<double>(*convert(value, "double"));
        return Done::next;
    }
    const std::optional<std::int64_t> turns = turns_of(value);
    if (turns) record.turns = *turns;
    return turns ? Done::next : Done::failed;
}

ProgramRun::Done ProgramRun::assign(Scope& scope, const Statement& statement) {
    ++covered()["set"];
    const std::string variable_name = statement.text.substr(0, statement.text.find('.'));
    Variables* const holder = scope.holder(variable_name);
    std::optional<std::int64_t> index;
    if (!statement.indices.empty()) {
        const std::optional<Value> at = evaluate(scope, statement.indices[0]);
        if (!at) return Done::failed;
        index = std::get<std::int64_t>(*at);
    }
    std::optional<Value> value = evaluate(scope, statement.expressions[0]);
    if (!value) return Done::failed;
    if (holder == nullptr) return scope.world->write(statement.text, *value) ? Done::next : Done::failed;
    Value& variable = holder->values[variable_name];
    if (variable_name != statement.text) return set_part(variable, statement.text, *value);
    if (index) {
        auto& vector = std::get<Vector>(variable);
        if (*index < 0 || *index >= static_cast<std::int64_t>(vector.size())) return Done::failed;
        vector[static_cast<std::size_t>(*index)] = std::get<double>(*convert(*value, "double"));
        return Done::next;
    }
    value = convert(*value, holder->types[variable_name]);
    if (!value) return Done::failed;
    variable = *value;
    return Done::next;
}

ProgramRun::Done ProgramRun::wait(Scope& scope, const Statement& statement, std::int64_t now) {
    if (acted_) return now - entered_at_ >= time_limit_ ? Done::next : Done::wait;
    const std::optional<Value> value = evaluate(scope, statement.expressions[0]);
    if (!value) return Done::failed;
    if (const auto* time = std::get_if<Span>(&*value)) {
        ++covered()["wait for time"];
        acted_ = true; // the duration is evaluated once
        time_limit_ = time->ns;
        return now - entered_at_ >= time->ns ? Done::next : Done::wait;
    }
    ++covered()["wait for a condition"];
    if (std::get<bool>(*value)) return Done::next;
    if (!statement.has_timeout) return Done::wait;
    const std::optional<Value> limit = evaluate(scope, statement.timeout);
    if (now - entered_at_ < std::get<Span>(*limit).ns) return Done::wait;
    ++covered()["time-out"];
    return Done::failed;
}

ProgramRun::Done ProgramRun::execute(Scope& scope, const Statement& statement, std::int64_t now) {
    const auto value_of = [&](std::size_t i) { return evaluate(scope, statement.expressions[i]); };
    const auto truth = [](const std::optional<Value>& value) { return std::get<bool>(*value); };
    using Kind = Statement::Kind;
    switch (statement.kind) {
    case Kind::declare: {
        ++covered()["var"];
        std::optional<Value> value = zero_of(statement.type);
        if (!statement.expressions.empty()) value = value_of(0);
        if (value) value = convert(*value, statement.type);
        if (!value) return Done::failed;
        Variables& block = stands_alone_ && open_.size() == 1 ? scope : open_.back().own;
        block.declare(statement.text, statement.type, *value);
        return Done::next;
    }
    case Kind::assign: return assign(scope, statement);
    case Kind::perform: return perform(scope, statement, now);
    case Kind::branch: {
        ++covered()["if"];
        const std::optional<Value> condition = value_of(0);
        if (!condition) return Done::failed;
        const Block& chosen = truth(condition) ? statement.first : statement.second;
        if (!truth(condition)) ++covered()["if not"];
        open_.push_back({.block = &chosen, .owner = &statement});
        return Done::elsewhere;
    }
    case Kind::loop: {
        ++covered()[statement.second.empty() ? "while" : "for"];
        const std::optional<Value> condition = value_of(0);
        if (!condition) return Done::failed;
        if (!truth(condition)) return Done::next;
        open_.push_back({.block = &statement.first, .owner = &statement});
        return Done::elsewhere;
    }
    case Kind::leave:
        ++covered()["return"];
        if (!statement.expressions.empty()) {
            ++covered()["return of a value"];
            const auto call =
                std::find_if(open_.rbegin(), open_.rend(), [](const Open& each) { return each.is_call; });
            std::optional<Value> value = value_of(0);
            if (value) value = convert(*value, call == open_.rend() ? result_type_ : call->function->result);
            if (!value) return Done::failed;
            result_ = *value;
        }
        while (!open_.empty() && !open_.back().is_call) open_.pop_back();
        if (open_.empty()) return Done::elsewhere;
        open_.pop_back();
        return Done::next;
    case Kind::pause:
        ++covered()["break"];
        while (open_.back().owner->kind != Kind::loop) open_.pop_back();
        open_.pop_back();
        return Done::next;
    case Kind::yield:
        if (std::exchange(acted_, true)) return Done::next;
        ++covered()["yield"];
        return Done::wait;
    case Kind::wait: return wait(scope, statement, now);
    case Kind::guarded:
        ++covered()["try"];
        open_.push_back({.block = &statement.first, .owner = &statement});
        return Done::elsewhere;
    }
    return Done::failed;
}

bool ProgramRun::take_arguments(Scope& scope, const Expression& call) {
    given_.clear();
    for (const Expression& part : call.parts) {
        const std::optional<Value> value = evaluate(scope, part);
        if (!value) return false;
        given_.push_back(*value);
    }
    return true;
}

ProgramRun::Done ProgramRun::perform_command(Scope& scope, const Statement& statement, std::int64_t now) {
    const Expression& call = statement.expressions[0];
    std::vector<Value>& given = given_; // a running command keeps its own
    const auto arguments = [&] { return take_arguments(scope, call); };
    const auto late = [&]() -> std::optional<bool> {
        if (!statement.has_timeout) return false;
        const std::optional<Value> limit = evaluate(scope, statement.timeout);
        if (!limit) return std::nullopt;
        return now - entered_at_ >= std::get<Span>(*limit).ns;
    };
    const auto waits_or_late = [&] {
        const std::optional<bool> is_late = late();
        if (!is_late || *is_late) {
            ++covered()["time-out"];
            return Done::failed;
        }
        return Done::wait;
    };
    if (scope.world->kind_of(call.text) == World::Kind::command) {
        if (!acted_) {
            ++covered()["own command"];
            if (!arguments()) return Done::failed;
            if (!scope.world->begin(call.text, given)) {
                ++covered()["command rejected"];
                return Done::failed;
            }
            acted_ = true;
        }
        switch (scope.world->progress(call.text, given)) {
        case Answer::yes: return Done::next;
        case Answer::failed: ++covered()["command failed"]; return Done::failed;
        case Answer::no: return waits_or_late();
        }
    } else {
        if (!acted_) {
            if (!arguments()) return Done::failed;
            again_ = !scope.world->send(call.text, given);
            if (again_) {
                ++covered()["command still on its way"];
                return waits_or_late();
            }
            ++covered()["peer's command"];
            acted_ = true;
        }
        switch (scope.world->ended(call.text)) {
        case Answer::yes: return Done::next;
        case Answer::failed: ++covered()["command failed"]; return Done::failed;
        case Answer::no: return waits_or_late();
        }
    }
    return Done::failed;
}

ProgramRun::Done ProgramRun::perform(Scope& scope, const Statement& statement, std::int64_t now) {
    const Expression& call = statement.expressions[0];
    std::vector<Value>& given = given_; // a running command keeps its own
    const auto arguments = [&] { return take_arguments(scope, call); };
    if (const Function* function = scope.function(call.text)) {
        ++covered()["function"];
        if (!arguments()) return Done::failed;
        Open call_of{.block = &function->body, .is_call = true, .function = function};
        for (std::size_t i = 0; i < given.size(); ++i) {
            const Variable& parameter = function->parameters[i];
            call_of.own.declare(parameter.name, parameter.type, *convert(given[i], parameter.type));
        }
        open_.push_back(call_of);
        return Done::elsewhere;
    }
    const World::Kind kind = scope.world->kind_of(call.text);
    if (kind == World::Kind::command || kind == World::Kind::sent_command)
        return perform_command(scope, statement, now);
    ++covered()["method"];
    if (!arguments()) return Done::failed;
    const std::optional<Value> result = scope.world->call(call.text, given);
    if (!result) return Done::failed;
    const bool* const answer = std::get_if<bool>(&*result); // as a statement: did it succeed?
    return answer == nullptr || *answer ? Done::next : Done::failed;
}

} // namespace tappet::reference

// Reads a script into its tree, by recursive descent.
#include "tests/differential/reference_words.hpp"

#include <algorithm>
#include <iostream>
#include <set>

namespace tappet::reference {
namespace {

[[noreturn]] void give_up(int line, const std::string& what) {
    std::cerr << "the reference cannot read line " << line << ": " << what << "\n";
    std::abort();
}

class Reader {
public:
    explicit Reader(std::string_view text) : words_{Words{text}.all()} {}

    Script script() {
        Script script;
        while (here().kind != Word::Kind::end) {
            if (take("StateMachine"))
                script.types.push_back(machine());
            else if (take("program"))
                script.types.push_back(program());
            else if (take("RootStateMachine"))
                script.roots.push_back(instance());
            else if (take("function"))
                script.functions.push_back(function());
            else
                fault("a StateMachine, program, function or RootStateMachine");
        }
        return script;
    }

private:
    // ---- words
    [[nodiscard]] const Word& here() const { return words_[at_]; }
    [[nodiscard]] bool is(std::string_view text, std::size_t ahead = 0) const {
        const Word& word = words_[std::min(at_ + ahead, words_.size() - 1)];
        return word.text == text && (word.kind == Word::Kind::name || word.kind == Word::Kind::sign);
    }
    bool take(std::string_view text) {
        if (!is(text)) return false;
        ++at_;
        return true;
    }
    void expect(std::string_view text) {
        if (!take(text)) fault(std::string{text});
    }
    std::string name() {
        if (here().kind != Word::Kind::name) fault("a name");
        return words_[at_++].text;
    }
    std::string dotted() {
        std::string text = name();
        while (take(".")) text += "." + name();
        return text;
    }
    [[noreturn]] void fault(const std::string& expected) const {
        give_up(here().line, "'" + here().text + "' where " + expected + " is expected");
    }
    void semicolons() {
        while (take(";")) {
        }
    }

    // ---- declarations outside of programs
    Instance instance() {
        Instance made{.type = name(), .name = name()};
        if (take("(")) made.arguments = list(")");
        semicolons();
        return made;
    }
    Variable variable(std::string kind) {
        Variable made{.kind = std::move(kind)};
        made.type = name();
        made.name = name();
        if (take("=")) {
            made.has_initial = true;
            made.initial = expression();
        }
        return made;
    }
    void variables(std::vector<Variable>& into, const std::string& kind) {
        into.push_back(variable(kind));
        const std::string type = into.back().type;
        while (take(",")) {
            Variable more{.name = name(), .type = type, .kind = kind};
            if (take("=")) {
                more.has_initial = true;
                more.initial = expression();
            }
            into.push_back(more);
        }
        semicolons();
    }
    Function function() {
        Function made;
        made.name = name();
        if (here().kind == Word::Kind::name) {
            made.result = made.name;
            made.name = name();
        }
        expect("(");
        while (!take(")")) {
            made.parameters.push_back(variable("param"));
            static_cast<void>(take(","));
        }
        made.body = block();
        const bool is_value = made.body.size() == 1 && made.body[0].kind == Statement::Kind::leave;
        if (!made.result.empty() && !is_value) with_statements_.insert(made.name);
        return made;
    }
    Type program() {
        Type made{.name = name(), .is_program = true};
        if (here().kind == Word::Kind::name) {
            made.result = made.name;
            made.name = name();
            give_results_.insert(made.name);
        }
        if (take("(")) {
            made.on_command = true;
            while (!take(")")) {
                made.variables.push_back(variable("param"));
                static_cast<void>(take(","));
            }
        }
        expect("{");
        while (is("param") || is("function")) {
            if (take("function"))
                made.functions.push_back(function());
            else
                variables(made.variables, words_[at_++].text);
        }
        while (!take("}")) statement(made.body);
        semicolons();
        return made;
    }
    Type machine() {
        Type made{.name = name()};
        expect("{");
        while (!take("}")) {
            if (is("var") || is("param") || is("const"))
                variables(made.variables, words_[at_++].text);
            else if (take("SubStateMachine"))
                made.children.push_back(instance());
            else if (take("function"))
                made.functions.push_back(function());
            else
                state(made, "", "");
        }
        semicolons();
        return made;
    }
    void state(Type& machine, const std::string& parent, const std::string& region) {
        State made{.parent = parent, .region = region};
        for (;;) {
            if (take("initial"))
                made.initial = true;
            else if (take("final"))
                made.final = true;
            else
                break;
        }
        expect("state");
        made.name = name();
        if (take("in")) made.parent = name();
        expect("{");
        const std::size_t place = machine.states.size();
        machine.states.push_back(made);
        while (!take("}")) {
            if (is("initial") || is("final") || is("state")) {
                state(machine, made.name, "");
            } else if (take("region")) {
                const std::string name_of_region = name();
                expect("{");
                while (!take("}")) state(machine, made.name, name_of_region);
            } else if (take("precondition")) {
                expect("(");
                made.preconditions.push_back(expression());
                expect(")");
            } else if (take("entry")) {
                made.entry = block();
            } else if (take("run")) {
                made.run = block();
            } else if (take("exit")) {
                made.exit = block();
            } else if (take("handle")) {
                made.handle = block();
            } else if (take("transitions")) {
                expect("{");
                while (!take("}")) transition(made, false);
            } else if (take("transition")) {
                transition(made, true);
            } else {
                fault("a part of a state");
            }
            semicolons();
        }
        machine.states[place] = made;
        semicolons();
    }
    void transition(State& state, bool may_be_event) {
        Transition made;
        std::string otherwise_enters;
        if (take("after")) {
            made.timed = true;
            made.after = expression();
        } else if (may_be_event && !is("if") && !is("select") && !is("{")) {
            made.event = dotted();
            if (take("("))
                while (!take(")")) {
                    made.captures.push_back(name());
                    static_cast<void>(take(","));
                }
        }
        if (take("if")) {
            made.has_guard = true;
            made.guard = expression();
            if (take("because")) ++at_; // a reason has no effect on the order
            static_cast<void>(take("then"));
        }
        if (is("{")) made.then = block();
        target(made.to, made.enters);
        if (made.event.empty() && made.to.empty()) fault("select");
        if (take("else")) {
            made.has_otherwise = true;
            if (is("{")) made.otherwise = block();
            target(made.otherwise_to, otherwise_enters);
        }
        semicolons();
        if (made.event.empty() && made.has_otherwise) { // is the next condition, which always holds
            made.has_otherwise = false;
            state.transitions.push_back(made);
            made.has_guard = false;
            made.then = made.otherwise;
            made.to = made.otherwise_to;
            made.enters = otherwise_enters;
            state.transitions.push_back(made);
            return;
        }
        state.transitions.push_back(made);
    }
    void target(std::string& to, std::string& enters) {
        if (!take("select")) return;
        if (take("deep")) enters = "deep ";
        if (is("history") && is("(", 1)) {
            at_ += 2;
            enters += "history";
            to = name();
            expect(")");
        } else {
            to = name();
        }
        semicolons();
    }

    // ---- programs
    Block block() {
        Block made;
        if (take("{"))
            while (!take("}")) statement(made);
        else
            statement(made);
        return made;
    }
    void assignment(Block& into, int line) {
        Statement made{.kind = Statement::Kind::assign, .line = line};
        made.text = name();
        for (;;) {
            if (take("["))
                made.indices.push_back(expression()), expect("]");
            else if (take("."))
                made.text += "." + name();
            else
                break;
        }
        expect("=");
        made.expressions.push_back(expression());
        Expression& value = made.expressions[0];
        if (value.kind == Expression::Kind::call && with_statements_.contains(value.text)) {
            Statement call{.kind = Statement::Kind::perform, .line = line};
            call.expressions.push_back(value);
            into.push_back(call);
            value = {.kind = Expression::Kind::name, .text = std::string{result_of_call}};
        }
        into.push_back(made);
    }
    void timeout(Statement& of) {
        of.has_timeout = take("timeout");
        if (of.has_timeout) of.timeout = expression();
    }
    void perform(Block& into, int line) {
        Statement made{.kind = Statement::Kind::perform, .line = line};
        made.expressions.push_back(postfix());
        timeout(made);
        Expression& call = made.expressions[0];
        if (!give_results_.contains(call.text)) return into.push_back(made);
        Statement fetched{.kind = Statement::Kind::assign, .line = line};
        fetched.text = call.parts.back().text;
        fetched.expressions.push_back(
            {.kind = Expression::Kind::name, .text = std::string{result_of_program}});
        call.parts.pop_back();
        into.push_back(made);
        into.push_back(fetched);
    }
    void statement(Block& into) {
        const int line = here().line;
        if (take(";")) return;
        if (is("{")) {
            for (Statement& each : block()) into.push_back(std::move(each));
        } else if (is("var") || is("const")) {
            std::vector<Variable> declared;
            variables(declared, words_[at_++].text);
            for (Variable& each : declared) {
                Statement made{.kind = Statement::Kind::declare, .line = line};
                made.text = each.name;
                made.type = each.type;
                made.counts = each.kind != "const";
                if (each.has_initial) made.expressions.push_back(each.initial);
                into.push_back(made);
            }
        } else if (take("set")) {
            assignment(into, line);
        } else if (take("do")) {
            perform(into, line);
        } else if (take("try")) {
            Statement made{.kind = Statement::Kind::guarded, .counts = false, .line = line};
            made.first = block();
            semicolons();
            if (take("catch")) made.second = block();
            into.push_back(made);
        } else if (take("if")) {
            Statement made{.kind = Statement::Kind::branch, .line = line};
            made.expressions.push_back(expression());
            static_cast<void>(take("then"));
            made.first = block();
            if (take("else")) made.second = block();
            into.push_back(made);
        } else if (take("while")) {
            Statement made{.kind = Statement::Kind::loop, .line = line};
            made.expressions.push_back(expression());
            static_cast<void>(take("do_"));
            made.first = block();
            into.push_back(made);
        } else if (take("for")) {
            loop(into, line);
        } else if (take("return")) {
            Statement made{.kind = Statement::Kind::leave, .line = line};
            if (!is(";") && !is("}")) made.expressions.push_back(expression());
            into.push_back(made);
        } else if (take("yield")) {
            into.push_back({.kind = Statement::Kind::yield, .line = line});
        } else if (take("break")) {
            into.push_back({.kind = Statement::Kind::pause, .line = line});
        } else if (take("wait")) {
            Statement made{.kind = Statement::Kind::wait, .line = line};
            expect("(");
            made.expressions.push_back(expression());
            expect(")");
            timeout(made);
            into.push_back(made);
        } else {
            fault("a statement");
        }
        semicolons();
    }
    void loop(Block& into, int line) {
        expect("(");
        if (is("var")) {
            statement(into);
        } else if (!take(";")) {
            static_cast<void>(take("set"));
            assignment(into, line);
            expect(";");
        }
        Statement made{.kind = Statement::Kind::loop, .line = line};
        made.expressions.push_back(expression());
        expect(";");
        static_cast<void>(take("set"));
        assignment(made.second, line);
        expect(")");
        made.first = block();
        into.push_back(made);
    }

    // ---- expressions, from the weakest operator on
    std::vector<Expression> list(std::string_view end) {
        std::vector<Expression> made;
        while (!take(end)) {
            made.push_back(expression());
            static_cast<void>(take(","));
        }
        return made;
    }
    [[nodiscard]] int strength() const {
        constexpr std::pair<std::string_view, int> signs[] = {
            {"||", 1}, {"or", 1}, {"&&", 2}, {"and", 2}, {"==", 3}, {"!=", 3}, {"<", 4}, {">", 4},
            {"<=", 4}, {">=", 4}, {"+", 5},  {"-", 5},   {"*", 6},  {"/", 6},  {"%", 6}};
        for (const auto& [sign, value] : signs)
            if (is(sign)) return value;
        return 0;
    }
    Expression expression(int at_least = 1) {
        Expression left = unary();
        for (int now = strength(); now >= at_least; now = strength()) {
            Expression made{.kind = Expression::Kind::binary, .text = here().text};
            if (made.text == "or") made.text = "||";
            if (made.text == "and") made.text = "&&";
            ++at_;
            Expression right = expression(now + 1);
            made.parts.push_back(std::move(left));
            made.parts.push_back(std::move(right));
            left = std::move(made);
        }
        return left;
    }
    Expression unary() {
        for (std::string_view sign : {"!", "not", "-", "+"})
            if (is(sign)) {
                Expression made{.kind = Expression::Kind::unary, .text = here().text};
                if (made.text == "not") made.text = "!";
                ++at_;
                made.parts.push_back(unary());
                return made;
            }
        return postfix();
    }
    Expression postfix() {
        Expression made;
        const Word word = here();
        if (take("(")) {
            made = expression();
            expect(")");
        } else if (word.kind == Word::Kind::name) {
            if (take("true") || take("false")) {
                made.value = word.text == "true";
            } else {
                made.kind = Expression::Kind::name;
                made.text = dotted();
                if (take("(")) {
                    made.kind = Expression::Kind::call;
                    made.parts = list(")");
                }
            }
        } else if (word.kind == Word::Kind::end || word.kind == Word::Kind::sign) {
            fault("a value");
        } else {
            made.value = word.value;
            ++at_;
        }
        while (take("[")) {
            Expression element{.kind = Expression::Kind::element};
            element.parts.push_back(std::move(made));
            element.parts.push_back(expression());
            expect("]");
            made = std::move(element);
        }
        return made;
    }

    std::vector<Word> words_;
    std::size_t at_ = 0;
    std::set<std::string> with_statements_; ///< functions that give a value and are no expression
    std::set<std::string> give_results_{};  ///< programs
};

} // namespace

Script read(std::string_view text) { return Reader{text}.script(); }

} // namespace tappet::reference

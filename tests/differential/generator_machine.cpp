// State machines of generated scripts.
#include "tests/differential/generator.hpp"

#include <array>

namespace tappet {

namespace {

/// Events that lead around the circle of states at each depth.
constexpr std::array<std::string_view, 4> circle_events = {"tick()", "mate.tick()", "switched(p)",
                                                           "moved(a, x)"};

} // namespace

std::string Generator::script() {
    text_.clear();
    line("// generated");
    if (!options_.machine) {
        open("program m");
        variables();
        block(6 + static_cast<int>(below(8)), 3, true);
        close();
        return text_;
    }
    if (one_in(2)) aid();
    has_child_ = options_.children && one_in(2);
    if (has_child_) child_type();
    machine();
    line("RootStateMachine Machine m(" + std::to_string(below(20)) + ", 2.5)");
    return text_;
}

void Generator::declare(std::string_view word, Kind kind, const std::string& name) {
    const std::string value =
        kind == Kind::vector || kind == Kind::record || word == "param" ? "" : " = " + literal(kind);
    line(std::string{word} + " " + std::string{type_of(kind)} + " " + name + value + ";");
    names_.push_back({name, kind, word != "const"});
}

void Generator::variables() {
    declare("var", Kind::integer, "a");
    declare("var", Kind::integer, "b");
    declare("const", Kind::integer, "k");
    declare("var", Kind::real, "x");
    declare("var", Kind::real, "y");
    declare("var", Kind::boolean, "p");
    declare("var", Kind::boolean, "q");
    declare("var", Kind::time, "t");
    declare("var", Kind::record, "c");
    declare("var", Kind::record, "d");
    declare("var", Kind::text, "s");
    declare("var", Kind::text, "r");
    declare("var", Kind::vector, "v");
    declare("var", Kind::vector, "w");
}

void Generator::program_of(std::string_view what, std::uint64_t seldom, bool may_wait) {
    if (one_in(seldom)) return;
    open(std::string{what});
    block(1 + static_cast<int>(below(3)), 2, may_wait);
    close();
}

void Generator::child_type() {
    open("StateMachine Child");
    in_child_ = true;
    const std::vector<Named> kept = names_;
    declare("param", Kind::integer, "load");
    declare("var", Kind::boolean, "p");
    open("initial state A");
    program_of("entry", 3, one_in(3));
    program_of("run", 3, one_in(2));
    line("transitions { if load > 3 then select B }");
    line("transition switched(p) select B");
    close();
    open("state B");
    program_of("entry", 3, one_in(3));
    program_of("run", 2, one_in(2));
    program_of("exit", 3, one_in(3));
    line("transitions { if " + expression(Kind::boolean, 1) + " then select A");
    line("after(" + literal(Kind::time) + ") select F }");
    close();
    open("final state F");
    program_of("entry", 3, false);
    close();
    close();
    names_ = kept;
    in_child_ = false;
}

// As a child, it knows no names of the machine.
void Generator::aid() {
    open("program int aid(int n, bool how)");
    in_child_ = returns_value_ = true;
    returned_ = Kind::integer;
    const std::vector<Named> kept = names_;
    names_.push_back({"n", Kind::integer});
    names_.push_back({"how", Kind::boolean});
    declare("var", Kind::real, "z");
    block(1 + static_cast<int>(below(3)), 2, true);
    line("return " + expression(Kind::integer, 1) + ";");
    names_ = kept;
    in_child_ = returns_value_ = false;
    returned_ = Kind::real;
    close();
    has_aid_ = true;
}

void Generator::plan() {
    states_.clear();
    const int count = 3 + static_cast<int>(below(static_cast<std::size_t>(options_.states)));
    for (int i = 0; i < count; ++i) {
        Planned made{.name = "S" + std::to_string(i), .region = "", .initial = i == 0, .final = i == 1};
        if (i > 2 && options_.nested && !one_in(3)) {
            int parent = one_in(4) ? 0 : 2 + static_cast<int>(below(static_cast<std::size_t>(i - 2)));
            if (depth_of(static_cast<std::size_t>(parent)) + 2 > circle_events.size()) parent = 0;
            Planned& around = states_[static_cast<std::size_t>(parent)];
            if (!around.composite) {
                around.composite = true;
                around.has_regions = one_in(3) && i + 1 < count;
                made.initial = true;
                if (around.has_regions) {
                    made.parent = parent;
                    made.region = "east";
                    states_.push_back(made);
                    made = {.name = "S" + std::to_string(++i), .region = "west", .initial = true};
                }
            } else if (around.has_regions) {
                made.region = one_in(2) ? "east" : "west";
            }
            made.parent = parent;
        }
        states_.push_back(made);
    }
}

std::vector<std::size_t> Generator::inside(int parent, const std::string& region) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < states_.size(); ++i)
        if (states_[i].parent == parent && states_[i].region == region) found.push_back(i);
    return found;
}

// One of them is an expression, the other one has statements.
void Generator::functions() {
    in_function_ = true;
    const std::size_t kept = names_.size();
    names_.push_back({"n", Kind::integer, false});
    open("function int half(int n)");
    line("return " + expression(Kind::integer, 2) + ";");
    close();
    names_.push_back({"m", Kind::real, false});
    open("function double pick(double m, int n)");
    returns_value_ = true;
    if (one_in(2)) statement(1, one_in(3));
    returns_value_ = false;
    line("if " + expression(Kind::boolean, 1) + " then return " + expression(Kind::real, 1) + ";");
    line("return " + expression(one_in(4) ? Kind::integer : Kind::real, 1) + ";");
    close();
    names_.resize(kept);
    in_function_ = false;
    has_value_functions_ = true;
}

void Generator::machine() {
    open("StateMachine Machine");
    declare("param", Kind::integer, "goal");
    declare("param", Kind::real, "speed");
    variables();
    if (has_child_) line("SubStateMachine Child left(" + std::to_string(below(6)) + ")");
    if (one_in(2)) functions();
    if (one_in(2)) {
        functions_.push_back("helper");
        open("function helper(int n)");
        names_.push_back({"n", Kind::integer, false});
        in_function_ = true;
        block(2, 1, one_in(2));
        in_function_ = false;
        names_.pop_back();
        close();
    }
    plan();
    for (std::size_t i = 0; i < states_.size(); ++i)
        if (states_[i].parent < 0) state(i);
    close();
}

void Generator::state(std::size_t index) {
    const Planned planned = states_[index];
    open(std::string{planned.initial ? "initial " : planned.final ? "final " : ""} + "state " + planned.name);
    if (!planned.initial && !planned.final && one_in(6))
        line("precondition(" + expression(Kind::boolean, 1) + ")");
    program_of("entry", 2, one_in(3));
    program_of("run", 2, one_in(2));
    program_of("exit", 2, one_in(4));
    program_of("handle", 2, one_in(4));
    transitions(index);
    if (planned.has_regions)
        for (const std::string region : {"east", "west"}) {
            open("region " + region);
            for (std::size_t i : inside(static_cast<int>(index), region)) state(i);
            close();
        }
    else
        for (std::size_t i : inside(static_cast<int>(index), "")) state(i);
    close();
}

std::size_t Generator::depth_of(std::size_t index) const {
    std::size_t depth = 0;
    for (int up = states_[index].parent; up >= 0; up = states_[static_cast<std::size_t>(up)].parent) ++depth;
    return depth;
}

std::string Generator::target(std::size_t from) {
    const Planned& source = states_[from];
    const std::vector<std::size_t> siblings = inside(source.parent, source.region);
    if (one_in(2)) return states_[any(siblings)].name;
    // Any state that is not in another region of the same composite.
    for (int tries = 0; tries < 8; ++tries) {
        const std::size_t to = below(states_.size());
        bool crosses = false;
        for (int a = static_cast<int>(from); a >= 0; a = states_[static_cast<std::size_t>(a)].parent)
            for (int b = static_cast<int>(to); b >= 0; b = states_[static_cast<std::size_t>(b)].parent) {
                const Planned& x = states_[static_cast<std::size_t>(a)];
                const Planned& y = states_[static_cast<std::size_t>(b)];
                if (x.parent >= 0 && x.parent == y.parent && x.region != y.region) crosses = true;
            }
        if (!crosses) return states_[to].name;
    }
    return states_[any(siblings)].name;
}

std::string Generator::select(std::size_t from) {
    const std::string to = target(from);
    for (const Planned& each : states_)
        if (each.name == to && each.composite && one_in(2))
            return std::string{"select "} + (one_in(2) ? "deep " : "") + "history(" + to + ")";
    return "select " + to;
}

void Generator::transitions(std::size_t index) {
    const Planned& planned = states_[index];
    const std::vector<std::size_t> siblings = inside(planned.parent, planned.region);
    if (planned.final) return;
    // Leads around the circle of its siblings, so that each state is reached and left.
    std::size_t next = siblings[0];
    for (std::size_t i = 0; i + 1 < siblings.size(); ++i)
        if (siblings[i] == index) next = siblings[i + 1];
    if (states_[next].final) next = siblings[siblings.size() > 2 ? 2 : 0];
    const std::size_t conditions = below(3);
    if (conditions > 0) {
        open("transitions");
        for (std::size_t i = 1; i <= conditions; ++i)
            condition_transition(index, i == conditions && depth_of(index) == 0 && one_in(2));
        close();
    }
    for (std::size_t i = below(3); i > 0; --i) event_transition(index, {}, {});
    static constexpr std::array<std::string_view, 2> others = {"mate.moved(b, y)", "mate.switched(q)"};
    if (depth_of(index) == 0 && one_in(3)) event_transition(index, any(others), "select " + target(index));
    event_transition(index, circle_events[depth_of(index)], "select " + states_[next].name);
}

void Generator::condition_transition(std::size_t index, bool always) {
    const bool timed = always || one_in(4);
    const bool guarded = !always || one_in(2);
    const std::string after = timed ? "after(" + literal(Kind::time) + ") " : "";
    const std::string guard = guarded ? "if " + expression(Kind::boolean, 2) + " then " : "";
    if (one_in(2)) return line(after + guard + select(index));
    open(after + guard);
    block(1 + static_cast<int>(below(2)), 1, one_in(3));
    --depth_;
    line("} " + select(index));
    if (guarded && always && one_in(2)) line("else " + select(index));
}

// A transition that always comes first hides those after it. Therefore a transition without a guard, or with
// an else branch, waits for the event of its circle, or another event at the outermost level; no transition
// with a guard waits for the event of an inner circle. `always`: always selected.
void Generator::event_transition(std::size_t index, std::string_view event, const std::string& always) {
    static constexpr std::array<std::string_view, 4> others = {"mate.moved(b, y)", "mate.switched(q)",
                                                               "mate.moved(a, x)", "mate.switched(p)"};
    const std::size_t circles = depth_of(index) + 1;
    const std::size_t drawn = below(circles + 2);
    if (event.empty()) event = drawn < circles ? circle_events[drawn] : any(others);
    const bool guarded = always.empty() || one_in(3);
    const bool internal = guarded && one_in(3);
    const std::string way = internal ? "" : " " + (guarded ? select(index) : always);
    std::string head = "transition " + std::string{event};
    if (guarded) head += " if " + expression(Kind::boolean, 2) + " then";
    if (internal || one_in(2)) {
        open(head);
        block(1 + static_cast<int>(below(2)), 1, one_in(3));
        --depth_;
        head = "}";
    }
    line(head + way);
    if (!guarded || always.empty()) return;
    if (one_in(2)) return line("else " + always);
    open("else");
    block(1, 1, one_in(3));
    --depth_;
    line(one_in(4) && depth_of(index) == 0 && event.starts_with("mate") ? "}" : "} " + always);
}

} // namespace tappet

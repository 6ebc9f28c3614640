// Finds the cycles of a function's instructions and the counter of each.
#include "tests/waitfree/loops.hpp"

#include "tests/waitfree/values.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace tappet::waitfree {

namespace {

using Nodes = std::set<std::size_t>;

/// Nodes reachable from `from` by at least one step within `within`, not passing through `avoided`.
Nodes reach(const Function& function, const Nodes& within, std::size_t from, const Nodes& avoided = {}) {
    Nodes found;
    std::vector<std::size_t> open;
    const auto step = [&](std::size_t at) {
        for (const std::size_t next : function.successors(at))
            if (!avoided.contains(next) && within.contains(next) && found.insert(next).second)
                open.push_back(next);
    };
    if (!avoided.contains(from)) step(from);
    while (!open.empty()) {
        const std::size_t at = open.back();
        open.pop_back();
        step(at);
    }
    return found;
}

/// The sets of `within` whose members all reach each other.
std::vector<Nodes> cycles(const Function& function, const Nodes& within) {
    std::vector<Nodes> found;
    Nodes left = within;
    while (!left.empty()) {
        const std::size_t at = *left.begin();
        left.erase(left.begin());
        const Nodes forward = reach(function, within, at);
        if (!forward.contains(at)) continue;
        Nodes cycle;
        for (const std::size_t each : forward)
            if (reach(function, within, each).contains(at)) cycle.insert(each);
        for (const std::size_t each : cycle) left.erase(each);
        found.push_back(std::move(cycle));
    }
    return found;
}

bool leads_to(const Function& function, std::size_t at, std::size_t to) {
    const auto next = function.successors(at);
    return std::ranges::find(next, to) != next.end();
}

enum class Leaves : std::uint8_t { when_equal, upwards, downwards, never };

/// The direction in which the left operand leaves the loop, for a jump that leaves on this condition of
/// (left, right).
Leaves side(std::string_view condition) {
    static constexpr std::array equal{"je"};
    static constexpr std::array up{"ja", "jae", "jnb", "jg", "jge", "jns"};
    static constexpr std::array down{"jb", "jbe", "jl", "jle", "js"};
    const auto in = [&](const auto& names) { return std::ranges::find(names, condition) != names.end(); };
    if (in(equal)) return Leaves::when_equal;
    if (in(up)) return Leaves::upwards;
    return in(down) ? Leaves::downwards : Leaves::never;
}

std::string_view negated(std::string_view condition) {
    static constexpr std::array<std::pair<std::string_view, std::string_view>, 7> pairs{{{"je", "jne"},
                                                                                         {"ja", "jbe"},
                                                                                         {"jae", "jb"},
                                                                                         {"jg", "jle"},
                                                                                         {"jge", "jl"},
                                                                                         {"js", "jns"},
                                                                                         {"jnb", "jb"}}};
    for (const auto& [one, other] : pairs) {
        if (condition == one) return other;
        if (condition == other) return one;
    }
    return {};
}

/// The comparison of a conditional jump that counts a cycle.
struct Test {
    Value counter;
    Value bound;
    std::optional<std::uint64_t> passes;
    bool operator==(const Test&) const = default;
};

/// The examination of one cycle.
class Examination {
public:
    Examination(const Function& function, const States& in_function, const Nodes& cycle, std::size_t header)
        : function_{function}, in_function_{in_function}, cycle_{cycle}, header_{header} {
        State first = in_function.at(header);
        for (auto& [place, value] : first)
            if (!value.known()) value = {Value::Kind::at_header, place, 0};
        states_ = follow(function, cycle, header, first);
        for (const std::size_t at : cycle) {
            if (!leads_to(function, at, header)) continue;
            State after = states_.at(at);
            execute(function.code[at], after);
            returns_.push_back(std::move(after));
        }
    }

    /// Checks this conditional jump; false: it does not count the cycle.
    bool counted_by(std::size_t jump, Test& test) const {
        const Instruction& exit = function_.code[jump];
        const bool taken_leaves = exit.target == none || !cycle_.contains(exit.target);
        if (taken_leaves != (jump + 1 < function_.code.size() && cycle_.contains(jump + 1))) return false;
        std::size_t setter = jump;
        do {
            if (setter == 0 || setter == header_ || is_joined(setter)) return false;
            --setter;
        } while (!writes_flags(function_.code[setter]));
        const Instruction& compare = function_.code[setter];
        if (!cycle_.contains(setter) || compare.operands.empty()) return false;

        State state = states_.at(setter);
        Value left;
        Value right{Value::Kind::constant, {}, 0};
        if (compare.is("cmp")) {
            left = value_of(state, compare.operands[0]);
            right = value_of(state, compare.operands[1]);
        } else if (compare.is("test") && compare.operands[0] == compare.operands[1]) {
            left = value_of(state, compare.operands[0]);
        } else if (compare.is("add") || compare.is("sub") || compare.is("inc") || compare.is("dec")) {
            if (compare.is("sub") && value_of(state, compare.operands[1]).kind != Value::Kind::constant)
                return false;
            execute(compare, state);
            left = value_of(state, compare.operands[0]);
        }
        const std::string condition{taken_leaves ? std::string_view{exit.mnemonic} : negated(exit.mnemonic)};
        return pairs(left, right, side(condition), test) ||
               pairs(right, left, mirrored(side(condition)), test);
    }

private:
    static Leaves mirrored(Leaves side) {
        if (side == Leaves::upwards) return Leaves::downwards;
        return side == Leaves::downwards ? Leaves::upwards : side;
    }

    /// Whether another path enters at this instruction, so that the previous one need not have run.
    [[nodiscard]] bool is_joined(std::size_t at) const {
        return std::ranges::any_of(function_.code,
                                   [at](const Instruction& each) { return each.target == at; });
    }

    /// The change of a place in one pass, equal on every path; 0: none, or unknown.
    [[nodiscard]] std::int64_t step_of(const Place& place) const {
        std::int64_t step = 0;
        for (const State& after : returns_) {
            const Value value = value_of(after, place);
            if (value.kind != Value::Kind::at_header || value.of != place || value.offset == 0) return 0;
            if (step != 0 && (step > 0) != (value.offset > 0)) return 0;
            if (step == 0 || std::abs(value.offset) < std::abs(step)) step = value.offset;
        }
        return step;
    }
    [[nodiscard]] bool unchanged(const Value& bound) const {
        if (bound.kind == Value::Kind::constant || bound.kind == Value::Kind::at_entry ||
            bound.kind == Value::Kind::aligned)
            return true;
        return bound.kind == Value::Kind::at_header && std::ranges::all_of(returns_, [&](const State& after) {
                   return value_of(after, bound.of) == Value{Value::Kind::at_header, bound.of, 0};
               });
    }

    bool pairs(const Value& counter, const Value& bound, Leaves leaves, Test& test) const {
        if (counter.kind != Value::Kind::at_header || !unchanged(bound)) return false;
        const std::int64_t step = step_of(counter.of);
        if (step == 0 || leaves == Leaves::never) return false;
        if (leaves == Leaves::upwards && step < 0) return false;
        if (leaves == Leaves::downwards && step > 0) return false;
        test.counter = counter;
        test.bound = bound;
        const Value first = before(counter.of).plus(counter.offset);
        const Value last = bound.kind == Value::Kind::at_header ? before(bound.of).plus(bound.offset) : bound;
        if (!first.same_base(last)) return true;
        const std::int64_t distance = step > 0 ? last.offset - first.offset : first.offset - last.offset;
        const std::int64_t stride = std::abs(step);
        // A stepped-over bound would be met only after the counter wrapped, if ever.
        if (leaves == Leaves::when_equal && (distance < 0 || distance % stride != 0)) return false;
        test.passes =
            distance < 0
                ? 1
                : static_cast<std::uint64_t>(distance / stride + 1 + (leaves == Leaves::when_equal ? 0 : 1));
        return true;
    }

    /// The contents of a place when the cycle is entered.
    [[nodiscard]] Value before(const Place& place) const {
        std::optional<Value> value;
        for (const auto& [at, state] : in_function_) {
            if (cycle_.contains(at) || !leads_to(function_, at, header_)) continue;
            State after = state;
            execute(function_.code[at], after);
            const Value here = value_of(after, place);
            if (value && *value != here) return {};
            value = here;
        }
        return value.value_or(Value{});
    }

    const Function& function_;
    const States& in_function_;
    const Nodes& cycle_;
    std::size_t header_;
    States states_;
    std::vector<State> returns_; ///< the state at the end of each path back to the header
};

void examine(const Function& function, const States& in_function, const Nodes& within,
             std::vector<Loop>& loops) {
    for (const Nodes& cycle : cycles(function, within)) {
        Nodes headers;
        for (const auto& [at, state] : in_function)
            if (!cycle.contains(at))
                for (const std::size_t next : function.successors(at))
                    if (cycle.contains(next)) headers.insert(next);
        if (cycle.contains(0)) headers.insert(0);
        if (headers.empty()) continue; // nothing leads there
        const std::size_t header = *headers.begin();
        Loop loop{function.name, function.code[header].address, {}, {}, {}};
        if (headers.size() > 1) {
            loop.fault = "is entered at two places";
        } else {
            const Examination examination{function, in_function, cycle, header};
            loop.fault = "has no exit that every pass meets, by a counter against a bound that stays";
            // Compilers copy the end of a loop to diverging paths: the same test on each of them counts as
            // one.
            std::vector<std::pair<Test, Nodes>> tests;
            for (const std::size_t at : cycle) {
                Test test;
                if (!function.code[at].is_conditional() || !examination.counted_by(at, test)) continue;
                const auto same = std::ranges::find(tests, test, &std::pair<Test, Nodes>::first);
                if (same != tests.end())
                    same->second.insert(at);
                else
                    tests.push_back({test, {at}});
            }
            for (const auto& [test, places] : tests) {
                const bool on_every_pass =
                    places.contains(header) || !reach(function, cycle, header, places).contains(header);
                if (!on_every_pass) continue;
                loop.counter = to_string(test.counter.of);
                loop.passes = test.passes;
                loop.fault.clear();
                break;
            }
        }
        loops.push_back(loop);
        Nodes inside = cycle;
        inside.erase(header);
        if (headers.size() == 1) examine(function, in_function, inside, loops);
    }
}

/// A jump to a computed address: the end of a function that calls its argument, or a jump table.
bool jumps_by_table(const Function& function, std::size_t at) {
    const Instruction& jump = function.code[at];
    if (!jump.is_jump() || jump.target != none || !jump.symbol.empty() || jump.operands.empty()) return false;
    if (jump.mnemonic != "jmp" || jump.operands[0].contains('*')) return true;
    if (at == 0 || !(function.code[at - 1].is("add") || function.code[at - 1].is("lea"))) return false;
    return function.code[at - 1].operands[0] == jump.operands[0];
}

class Walk {
public:
    Walk(const Program& program, const Permission& permission, Verdict& verdict)
        : program_{program}, permission_{permission}, verdict_{verdict} {}

    void visit(const std::string& name, const std::string& from) {
        // A broken promise (noexcept, a smashed stack) ends the process: nothing follows it.
        static constexpr std::array ends{"__clang_call_terminate", "_ZSt9terminatev", "__stack_chk_fail",
                                         "abort"};
        if (std::ranges::find(ends, name) != ends.end()) return;
        if (open_.contains(name)) {
            verdict_.faults.push_back(name + " calls itself, through " + from);
            return;
        }
        const auto found = program_.find(name);
        if (found == program_.end()) {
            if (permission_.outside.contains(name))
                verdict_.outside.insert(name);
            else
                verdict_.faults.push_back(from + " calls " + name + ", whose code is not seen");
            return;
        }
        if (!verdict_.functions.insert(name).second) return;
        open_.insert(name);
        const Function& function = found->second;
        for (const Loop& loop : loops_of(function)) {
            verdict_.loops.push_back(loop);
            if (!loop.fault.empty())
                verdict_.faults.push_back(name + ": the loop at " +
                                          in_words(static_cast<std::int64_t>(loop.address)) + " " +
                                          loop.fault);
        }
        for (std::size_t at = 0; at < function.code.size(); ++at) {
            const Instruction& one = function.code[at];
            if (!one.symbol.empty()) {
                visit(one.symbol, name);
            } else if (jumps_by_table(function, at)) {
                verdict_.faults.push_back(name + " jumps by a table, which is not followed");
            } else if (one.is_call() || (one.is_jump() && one.target == none)) {
                verdict_.makes_given_calls = true;
                if (!permission_.given_calls) verdict_.faults.push_back(name + " calls what it is given");
            }
        }
        open_.erase(name);
    }

private:
    const Program& program_;
    const Permission& permission_;
    Verdict& verdict_;
    std::set<std::string> open_;
};

} // namespace

std::vector<Loop> loops_of(const Function& function) {
    std::vector<Loop> loops;
    if (function.code.empty()) return loops;
    Nodes all;
    for (std::size_t at = 0; at < function.code.size(); ++at) all.insert(at);
    // The header of a whole function is a place before it: nothing returns there.
    const Nodes reached = [&] {
        Nodes found = reach(function, all, 0);
        found.insert(0);
        return found;
    }();
    const States states = [&] {
        Function copy = function;
        for (Instruction& each : copy.code)
            if (each.target != none) ++each.target;
        copy.code.insert(copy.code.begin(), Instruction{0, "nop", {}, {}, none});
        Nodes shifted{0};
        for (const std::size_t at : reached) shifted.insert(at + 1);
        States found;
        for (auto& [at, state] : follow(copy, shifted, 0, State{}))
            if (at != 0) found[at - 1] = std::move(state);
        return found;
    }();
    examine(function, states, reached, loops);
    return loops;
}

Verdict check(const Program& program, const std::string& root, const Permission& permission) {
    Verdict verdict;
    if (!program.contains(root)) {
        verdict.faults.push_back(root + " is not among the functions");
        return verdict;
    }
    Walk{program, permission, verdict}.visit(root, root);
    return verdict;
}

} // namespace tappet::waitfree

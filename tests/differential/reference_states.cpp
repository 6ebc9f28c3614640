// Finds the states, and the way from some of them into others: programs, exits, entries, one at a time.
#include "tests/differential/reference_machine.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace tappet::reference {

Machine::Machine(const Script& script, const Instance& instance, const std::string& name, World& bench,
                 Policy policy, Machine* parent)
    : name_{name}, bench_{bench}, policy_{policy}, parent_{parent} {
    for (const Type& each : script.types)
        if (each.name == instance.type) type_ = &each;
    if (type_ == nullptr) std::abort();
    scope_.world = this;
    scope_.functions = &type_->functions;
    scope_.outer_functions = &script.functions;
    std::size_t argument = 0;
    Scope nothing{};
    nothing.world = &bench;
    for (const Variable& each : type_->variables) {
        Value value = zero_of(each.type);
        if (each.kind == "param" && argument < instance.arguments.size())
            value = *evaluate(parent != nullptr ? parent->scope_ : nothing, instance.arguments[argument++]);
        else if (each.has_initial)
            value = *evaluate(scope_, each.initial);
        scope_.types[each.name] = each.type;
        scope_.values[each.name] = *convert(value, each.type);
    }
    for (const Instance& each : type_->children)
        children_.push_back(std::make_unique<Machine>(script, each, each.name, bench, policy, this));
}

// ---- the tree

const State* Machine::find(const std::string& name) const {
    for (const State& each : type_->states)
        if (each.name == name) return &each;
    return nullptr;
}

std::vector<const State*> Machine::chain(const State* state) const {
    std::vector<const State*> up;
    for (; state != nullptr; state = find(state->parent)) up.insert(up.begin(), state);
    return up;
}

std::vector<std::string> Machine::regions_of(const std::string& parent) const {
    std::vector<std::string> found;
    for (const State& each : type_->states)
        if (each.parent == parent && std::ranges::find(found, each.region) == found.end())
            found.push_back(each.region);
    return found;
}

const State* Machine::initial_of(const std::string& parent, const std::string& region) const {
    for (const State& each : type_->states)
        if (each.parent == parent && each.region == region && each.initial) return &each;
    return nullptr;
}

Machine::Active* Machine::active_of(const State* state) {
    for (Active& each : active_)
        if (each.state == state) return &each;
    return nullptr;
}

bool Machine::is_in(const std::string& state) const {
    return std::ranges::any_of(active_, [&](const Active& each) { return each.state->name == state; });
}

bool Machine::is_inside(const State* state, const State* around) const {
    const std::vector<const State*> up = chain(state);
    return std::ranges::find(up, around) != up.end();
}

// Number of levels that contain both and are neither of the two.
std::size_t Machine::kept_of(const State* source, const State* target) const {
    const std::vector<const State*> a = chain(source);
    const std::vector<const State*> b = chain(target);
    std::size_t kept = 0;
    while (kept + 1 < a.size() && kept + 1 < b.size() && a[kept] == b[kept]) ++kept;
    return kept;
}

const State* Machine::remembered(const std::string& parent, const std::string& region) const {
    for (const Active& each : active_)
        if (each.state->parent == parent && each.state->region == region) return each.state;
    const auto found = history_.find(parent + "/" + region);
    return found != history_.end() ? found->second : initial_of(parent, region);
}

std::vector<const State*> Machine::entries(const State* target, std::size_t kept,
                                           const std::string& enters) const {
    const std::vector<const State*> path = chain(target);
    std::vector<const State*> list;
    const auto enter = [&](const auto& self, const State* state, bool deep) -> void {
        list.push_back(state);
        const auto here = std::ranges::find(path, state);
        const bool on_the_way = here != path.end() && here + 1 != path.end();
        const bool remembers = deep || (state == target && !enters.empty());
        for (const std::string& region : regions_of(state->name)) {
            if (on_the_way && (*(here + 1))->region == region)
                self(self, *(here + 1), false);
            else
                self(self, remembers ? remembered(state->name, region) : initial_of(state->name, region),
                     remembers && enters == "deep history");
        }
    };
    enter(enter, path[kept], false);
    return list;
}

std::vector<const State*> Machine::leaves() const {
    std::vector<const State*> list;
    for (const Active& each : active_)
        if (is_leaf(each.state)) list.push_back(each.state);
    return list;
}

std::vector<const State*> Machine::asked_at(const State* leaf) const {
    std::vector<const State*> list = chain(leaf);
    std::ranges::reverse(list);
    const std::vector<const State*> all = leaves();
    std::erase_if(list, [&](const State* each) {
        const State* last = nullptr;
        for (const State* other : all)
            if (is_inside(other, each)) last = other;
        return last != leaf;
    });
    return list;
}

std::string Machine::picture() const {
    std::string text = error_ ? "error" : is_active_ ? "active" : "inactive";
    if (paused_ && is_active_) text += " paused";
    if (is_active_ && !automatic_) text += " reactive";
    for (const Active& each : active_) text += " " + each.state->name;
    return text;
}

// ---- the act in hand

bool Machine::do_acts(std::int64_t now) {
    while (!acts_.empty()) {
        const Act act = acts_.front();
        switch (act.kind) {
        case Act::Kind::left:
            history_[act.state->parent + "/" + act.state->region] = act.state;
            std::erase_if(active_, [&](const Active& each) { return each.state == act.state; });
            std::erase_if(chosen_, [&](const Chosen& each) { return each.source == act.state; });
            break;
        case Act::Kind::plan: {
            acts_.pop_front();
            std::vector<Act> more;
            for (const State* each : entries(act.state, act.kept, act.enters)) {
                more.push_back({.kind = Act::Kind::enter, .state = each});
                if (!each->entry.empty())
                    more.push_back({.kind = Act::Kind::entered, .block = &each->entry, .state = each});
            }
            acts_.insert(acts_.begin(), more.begin(), more.end());
            continue;
        }
        case Act::Kind::enter: {
            // Inserts it after those that precede it in a walk through the whole tree.
            const std::vector<const State*> path = chain(act.state);
            const auto is_behind = [&](const State* state) {
                const std::vector<const State*> other = chain(state);
                std::size_t level = 0;
                while (level < path.size() && level < other.size() && path[level] == other[level]) ++level;
                if (level == path.size() || level == other.size()) return other.size() > path.size();
                const std::vector<std::string> regions = regions_of(path[level]->parent);
                return std::ranges::find(regions, other[level]->region) >
                       std::ranges::find(regions, path[level]->region);
            };
            std::size_t at = active_.size();
            while (at > 0 && is_behind(active_[at - 1].state)) --at;
            active_.insert(active_.begin() + static_cast<std::ptrdiff_t>(at),
                           {.state = act.state, .entered_at = now});
            break;
        }
        case Act::Kind::depart:
            acts_.clear();
            chosen_.clear();
            deferred_.clear();
            wanted_.clear();
            active_.clear();
            is_active_ = automatic_ = leaving_ = error_ = paused_ = final_wanted_ = mid_round_ = false;
            return true;
        default:
            if (left_ <= 0) return false;
            if (!current_.is_on()) current_.start(act.block);
            const ProgramRun::Result result = current_.run(scope_, now, left_);
            if (result == ProgramRun::Result::failed) {
                fail();
                return false;
            }
            if (result != ProgramRun::Result::ended) {
                count("a transition takes several steps");
                return false;
            }
        }
        if (error_) return false;
        acts_.pop_front();
    }
    to_final_ = false;
    return true;
}

bool Machine::work(std::int64_t now) {
    for (;;) {
        if (error_) return false;
        if (!acts_.empty()) {
            if (!do_acts(now)) return false;
            if (!is_active_) return true;
        } else if (chosen_.empty() || final_wanted_) {
            chosen_.clear();
            return true;
        } else {
            const Chosen next = chosen_.front();
            chosen_.pop_front();
            take(next);
            if (acts_.empty()) continue;
        }
    }
}

void Machine::fail() {
    error_ = true;
    current_.drop();
    count("machine in error");
    if (!policy_.escalates) return;
    for (Machine* above = parent_; above != nullptr; above = above->parent_) {
        if (!above->is_active_ || above->error_) return;
        count("child in error: so is its parent");
        above->error_ = true;
    }
}

// The program, the exits from the inside out, the entries from the outside in.
void Machine::plan(const State* source, const State* target, const Block& program,
                   const std::string& enters) {
    if (!program.empty()) acts_.push_back({.block = &program});
    if (target == nullptr) return;
    const std::size_t kept = kept_of(source, target);
    const State* const outermost = chain(source)[kept];
    for (std::size_t i = active_.size(); i-- > 0;) {
        const State* const each = active_[i].state;
        if (!is_inside(each, outermost)) continue;
        if (!each->exit.empty())
            acts_.push_back({.kind = Act::Kind::exit, .block = &each->exit, .state = each});
        acts_.push_back({.kind = Act::Kind::left, .state = each});
    }
    acts_.push_back({.kind = Act::Kind::plan, .state = target, .enters = enters, .kept = kept});
}

void Machine::take(const Chosen& chosen) {
    const Transition& t = *chosen.transition;
    asked_ = 0;
    for (Active& each : active_)
        if (each.phase == Phase::asked) each.phase = Phase::ran;
    const State* const target = find(chosen.otherwise ? t.otherwise_to : t.to);
    plan(chosen.source, target, chosen.otherwise ? t.otherwise : t.then, chosen.otherwise ? "" : t.enters);
    count(chosen.otherwise  ? "else branch"
          : t.timed         ? "timed transition"
          : t.event.empty() ? "condition transition"
                            : "event transition");
    if (target == nullptr) return count("internal transition");
    if (target == chosen.source) count("transition to itself");
    if (is_inside(chosen.source, target) && target != chosen.source) count("transition to a state around");
    if (is_inside(target, chosen.source) && target != chosen.source) count("transition into a state inside");
    if (!is_leaf(target)) count("composite entered");
    if (regions_of(target->name).size() > 1) count("regions entered");
    if (leaves().size() > 1) count("transition beside other regions");
    if (!chosen.otherwise && !t.enters.empty()) count(t.enters);
}

// A request leaves every state; an exit program that has begun runs to its end.
void Machine::replace(const State* target, bool departs) {
    chosen_.clear();
    run_once_ = false;
    asked_ = 0;
    std::deque<Act> begun;
    if (!acts_.empty() && acts_.front().kind == Act::Kind::exit && current_.is_on() && !error_) {
        begun.push_back(acts_[0]);
        begun.push_back(acts_[1]);
        count("request while an exit waits");
    } else {
        if (!acts_.empty()) count("request while a transition waits");
        current_.drop();
    }
    error_ = false;
    acts_ = begun;
    for (std::size_t i = active_.size(); i-- > 0;) {
        const State* const each = active_[i].state;
        if (!begun.empty() && each == begun[0].state) continue;
        if (!each->exit.empty())
            acts_.push_back({.kind = Act::Kind::exit, .block = &each->exit, .state = each});
        acts_.push_back({.kind = Act::Kind::left, .state = each});
    }
    if (departs)
        acts_.push_back({.kind = Act::Kind::depart});
    else
        acts_.push_back({.kind = Act::Kind::plan, .state = target});
    leaving_ = departs;
    to_final_ = target != nullptr && target->final;
}

} // namespace tappet::reference

// Requests to a machine from outside, and its programs' view of its children.
#include "tests/differential/reference_machine.hpp"

#include <algorithm>

namespace tappet::reference {

void Machine::serve_final(std::int64_t now) {
    if (!final_wanted_) return;
    final_wanted_ = false;
    const bool under_way = in_hand() && to_final_ && !error_;
    const bool is_there = is_final() && !in_hand() && !error_;
    if (!is_active_ || leaving_ || under_way || is_there) return;
    count(error_ ? "final state out of an error" : "final state by request");
    const State* target = nullptr;
    for (const State& each : type_->states)
        if (each.final) target = &each;
    replace(target, false);
    static_cast<void>(work(now));
}

bool Machine::serve_request(std::int64_t now) {
    const State* const target = find(wanted_);
    wanted_.clear();
    bool there = is_in(target->name);
    if (!there && target->final) {
        replace(target, false);
        there = true;
    } else if (!there && is_final() && target == initial_of("", "")) {
        replace(target, false);
        there = true;
    }
    for (const State* leaf : leaves()) {
        if (there) break;
        std::vector<const State*> up = chain(leaf);
        std::ranges::reverse(up);
        for (const State* state : up)
            for (const Transition& each : state->transitions) {
                if (there || !each.event.empty() || each.to != target->name) continue;
                const Reply reply = ask(state, each, nullptr, now);
                if (reply == Reply::failed) return false;
                if (reply != Reply::yes) continue;
                there = true;
                count("condition transition by request");
                take({state, &each, false});
            }
    }
    if (!there) return false;
    run_once_ = wanted_run_ && !automatic_;
    if (work(now) && run_once_) {
        count("run once by request");
        ran_.clear();
        round(now);
    }
    return true;
}

bool Machine::activate(std::int64_t now) {
    now_ = now;
    if (is_active_) return false;
    count("activated");
    is_active_ = true;
    automatic_ = run_once_ = paused_ = error_ = leaving_ = final_wanted_ = mid_round_ = false;
    acts_.clear();
    chosen_.clear();
    deferred_.clear();
    wanted_.clear();
    current_.drop();
    open();
    asked_ = 0;
    acts_.push_back({.kind = Act::Kind::plan, .state = initial_of("", "")});
    static_cast<void>(work(now));
    finish(now);
    return true;
}

bool Machine::start(std::int64_t now) {
    if (!is_active_) {
        const bool done = activate(now);
        automatic_ = done;
        return done;
    }
    if (automatic_ && !paused_) return false;
    paused_ = false;
    automatic_ = true;
    return true;
}

bool Machine::reactive() {
    if (!is_active_ || (!automatic_ && !paused_)) return false;
    count("reactive mode");
    paused_ = automatic_ = false;
    return true;
}

bool Machine::pause() {
    if (!is_active_ || paused_) return false;
    count("paused");
    paused_ = true;
    return true;
}

bool Machine::request_final(std::int64_t now) {
    now_ = now;
    if (!is_active_ || leaving_) return false;
    if (is_final() && !busy_ && !in_hand() && !error_) return false;
    final_wanted_ = true;
    if (busy_) return true;
    paused_ = false;
    open();
    finish(now);
    return true;
}

bool Machine::reset(std::int64_t now) {
    now_ = now;
    if (busy_ || in_hand() || error_ || !is_final()) return false;
    count("reset");
    paused_ = false;
    open();
    replace(initial_of("", ""), false);
    static_cast<void>(work(now));
    finish(now);
    return true;
}

bool Machine::deactivate(std::int64_t now) {
    now_ = now;
    if (!is_active_ || busy_ || (leaving_ && !error_)) return false;
    paused_ = final_wanted_ = false;
    deferred_.clear();
    wanted_.clear();
    open();
    if (!leaving_) {
        count("deactivated");
        replace(nullptr, true);
    } else {
        count("second deactivation");
        error_ = false;
        current_.drop();
        acts_.pop_front();
    }
    static_cast<void>(work(now));
    busy_ = false;
    return true;
}

bool Machine::request(const std::string& state, bool run_once, std::int64_t now) {
    now_ = now;
    if (!is_active_ || error_ || leaving_ || find(state) == nullptr) return false;
    if (!wanted_.empty()) {
        ++lost_;
        return false;
    }
    const bool waits = busy_ || in_hand() || !deferred_.empty() || paused_;
    wanted_ = state;
    wanted_run_ = run_once;
    if (waits) return true;
    open();
    const bool done = serve_request(now);
    finish(now);
    return done;
}

void Machine::step(std::int64_t now) {
    now_ = now;
    if (!is_active_ || busy_ || paused_ || error_) return;
    open();
    ran_.clear();
    conditions_left_ = false;
    serve_final(now);
    round(now);
    finish(now);
}

// Executes one statement of the act in hand or of a run program, or one condition, or one event.
void Machine::step_once(std::int64_t now) {
    now_ = now;
    if (!is_active_ || busy_ || !paused_ || error_) return;
    open();
    left_ = 1;
    single_ = true;
    if (!mid_round_) ran_.clear();
    if (!in_hand() && !mid_round_ && !deferred_.empty()) {
        count("event in a single step");
        left_ = 0;
        const Event next = deferred_.front();
        deferred_.pop_front();
        react(next, now);
    } else {
        round(now);
    }
    serve_final(now);
    busy_ = single_ = false;
}

// ---- as the world of its programs

std::string Machine::slot(const std::string& name) const {
    std::string scope = name_ + "|";
    if (running_ != nullptr) {
        scope += "run";
        for (const State* each : chain(running_)) scope += "/" + each->region;
    }
    return scope + "|" + name;
}

World::Kind Machine::kind_of(const std::string& name) const {
    for (const auto& child : children_)
        if (name.starts_with(child->name() + ".")) return Kind::method;
    return bench_.kind_of(name);
}

std::optional<Value> Machine::read(const std::string& name) {
    for (const auto& child : children_)
        if (name.starts_with(child->name() + "."))
            return child->scope_.values.at(name.substr(child->name().size() + 1));
    return bench_.read(name);
}

bool Machine::write(const std::string& name, const Value& value) {
    for (const auto& child : children_) {
        if (!name.starts_with(child->name() + ".")) continue;
        const std::string variable = name.substr(child->name().size() + 1);
        const std::optional<Value> fitting = convert(value, child->scope_.types.at(variable));
        if (!fitting) return false;
        child->scope_.values[variable] = *fitting;
        return true;
    }
    return bench_.write(name, value);
}

std::optional<Value> Machine::call(const std::string& name, const std::vector<Value>& given) {
    for (const auto& child : children_) {
        if (!name.starts_with(child->name() + ".")) continue;
        const std::string what = name.substr(child->name().size() + 1);
        count("child: " + what);
        if (what == "inState") return Value{child->is_in(std::get<std::string>(given[0]))};
        if (what == "inError") return Value{child->in_error()};
        if (what == "isActive") return Value{child->is_active_};
        if (what == "isPaused") return Value{child->paused_};
        if (what == "isStopped") return Value{child->is_final()};
        if (what == "activate") static_cast<void>(child->activate(now_));
        if (what == "start") static_cast<void>(child->start(now_));
        if (what == "pause") static_cast<void>(child->pause());
        if (what == "reactive") static_cast<void>(child->reactive());
        if (what == "stop") static_cast<void>(child->request_final(now_));
        if (what == "reset") static_cast<void>(child->reset(now_));
        if (what == "deactivate") static_cast<void>(child->deactivate(now_));
        if (what == "requestState" || what == "requestStateRun") {
            const std::size_t lost = child->lost_;
            child->request(std::get<std::string>(given[0]), what == "requestStateRun", now_);
            if (child->lost_ != lost) return std::nullopt;
        }
        return Value{};
    }
    return bench_.call(name, given);
}

} // namespace tappet::reference

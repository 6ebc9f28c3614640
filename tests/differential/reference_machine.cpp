// A step (run, conditions, handle), and the effect of an event.
#include "tests/differential/reference_machine.hpp"

#include <algorithm>

namespace tappet::reference {

// ---- questions

Machine::Reply Machine::test(const Expression& expression) {
    const std::optional<Value> value = evaluate(scope_, expression);
    if (!value) return Reply::failed;
    return std::get<bool>(*value) ? Reply::yes : Reply::no;
}

Machine::Reply Machine::may_enter(const State* source, const std::string& to, const std::string& enters) {
    const State* const target = find(to);
    if (target == nullptr) return Reply::yes;
    for (const State* state : entries(target, kept_of(source, target), enters))
        for (const Expression& each : state->preconditions) {
            count("precondition");
            const Reply reply = test(each);
            if (reply != Reply::yes) {
                count("precondition refuses");
                return reply;
            }
        }
    return Reply::yes;
}

Machine::Reply Machine::ask(const State* source, const Transition& transition,
                            const std::vector<Value>* given, std::int64_t now) {
    if (transition.timed) {
        const std::optional<Value> after = evaluate(scope_, transition.after);
        if (now - active_of(source)->entered_at < std::get<Span>(*after).ns) return Reply::no;
    }
    const auto failed = [&] {
        fail();
        count("guard fails");
        return Reply::failed;
    };
    for (std::size_t i = 0; i < transition.captures.size(); ++i) {
        count("argument captured");
        const std::string& name = transition.captures[i];
        scope_.values[name] = *convert((*given)[i], scope_.types[name]);
    }
    Reply reply = transition.has_guard ? test(transition.guard) : Reply::yes;
    if (reply == Reply::yes) reply = may_enter(source, transition.to, transition.enters);
    if (reply == Reply::no && transition.has_otherwise) {
        reply = may_enter(source, transition.otherwise_to, "");
        if (reply == Reply::yes) reply = Reply::otherwise;
    }
    return reply == Reply::failed ? failed() : reply;
}

// ---- a round of run, conditions and handle

void Machine::round(std::int64_t now) {
    if (!work(now) || !is_active_) return;
    if (!automatic_ && !run_once_) return;
    for (Active& each : active_)
        if (each.phase == Phase::waits)
            each.phase = Phase::under_way;
        else if (!mid_round_ && each.phase != Phase::under_way)
            each.phase = Phase::fresh;
    if (!mid_round_) asked_ = 0;
    mid_round_ = true;
    for (std::size_t taken = 0;;) {
        if (!run_states(now)) return;
        if (final_wanted_) {
            serve_final(now);
            if (in_hand() || error_) return;
            if (!run_states(now)) return;
        }
        if (!automatic_) break;
        Chosen found;
        const Reply reply = find_condition(now, found);
        if (reply == Reply::failed) return;
        if (reply == Reply::no) break;
        take(found);
        if (!work(now)) return;
        if (final_wanted_) {
            serve_final(now);
            if (in_hand() || error_) return;
        }
        if (++taken == most_transitions) {
            count("as many transitions in a step as there may be");
            conditions_left_ = true;
            mid_round_ = false;
            return;
        }
    }
    if (automatic_) {
        if (!handle_states(now)) return;
    } else {
        for (const Active& each : active_)
            if (each.phase == Phase::waits) return;
    }
    run_once_ = false;
    mid_round_ = false;
}

bool Machine::run_states(std::int64_t now) {
    for (std::size_t i = 0; i < active_.size(); ++i) {
        Active& at = active_[i];
        if (at.phase != Phase::fresh && at.phase != Phase::under_way) continue;
        if (at.state->run.empty()) {
            at.phase = Phase::ran;
            continue;
        }
        if (at.phase == Phase::fresh) {
            if (ran_.contains(at.state)) {
                count("entered again in the step in which it ran");
                at.phase = Phase::held;
                continue;
            }
            if (left_ <= 0) return false;
            at.run.start(&at.state->run);
        }
        ran_.insert(at.state);
        running_ = at.state;
        const ProgramRun::Result result = at.run.run(scope_, now, left_);
        running_ = nullptr;
        switch (result) {
        case ProgramRun::Result::ended: at.phase = Phase::ran; break;
        case ProgramRun::Result::failed: fail(); return false;
        case ProgramRun::Result::left_over: at.phase = Phase::under_way; return false;
        default: at.phase = Phase::waits;
        }
        if (error_) return false;
    }
    return true;
}

// A single step evaluates one condition; `failed`: it has done that.
Machine::Reply Machine::find_condition(std::int64_t now, Chosen& found) {
    std::size_t number = 0;
    for (const State* leaf : leaves())
        for (const State* state : asked_at(leaf))
            for (const Transition& each : state->transitions) {
                if (!each.event.empty()) continue;
                const Phase phase = active_of(state)->phase;
                if (phase != Phase::ran && !(phase == Phase::waits && each.timed)) continue;
                if (single_) {
                    if (number++ < asked_) continue;
                    if (left_ <= 0) return Reply::failed;
                    --left_, ++asked_;
                    count("condition in a single step");
                }
                const Reply reply = ask(state, each, nullptr, now);
                if (reply == Reply::no) continue;
                found = {state, &each, false};
                if (phase == Phase::waits) count("time-out of a run program");
                return reply;
            }
    for (Active& each : active_)
        if (each.phase == Phase::ran) each.phase = Phase::asked;
    return Reply::no;
}

bool Machine::handle_states(std::int64_t now) {
    for (std::size_t i = 0; i < active_.size(); ++i) {
        if (active_[i].phase != Phase::asked) continue;
        active_[i].phase = Phase::done;
        if (active_[i].state->handle.empty()) continue;
        count("handle in a round");
        acts_.push_back({.block = &active_[i].state->handle});
        if (!work(now)) return false;
    }
    return true;
}

// ---- events

void Machine::react(const Event& event, std::int64_t now) {
    const State* refused = nullptr;
    chosen_.clear();
    for (const State* leaf : leaves())
        for (const State* state : asked_at(leaf))
            for (const Transition& each : state->transitions) {
                if (each.event != event.name) continue;
                const bool is_taken = std::ranges::any_of(
                    chosen_, [&](const Chosen& other) { return is_inside(other.source, state); });
                if (is_taken) continue;
                const Reply reply = ask(state, each, &event.arguments, now);
                if (reply == Reply::failed) return;
                if (reply == Reply::no) {
                    if (refused == nullptr) refused = state;
                    continue;
                }
                chosen_.push_back({state, &each, reply == Reply::otherwise});
            }
    if (chosen_.size() > 1) count("one event in several regions");
    if (!chosen_.empty() || refused == nullptr) return;
    count("event refused");
    if (refused->handle.empty()) return;
    count("handle of a refused event");
    acts_.push_back({.block = &refused->handle});
}

void Machine::event(const std::string& name, const std::vector<Value>& arguments, std::int64_t now) {
    now_ = now;
    const bool known = std::ranges::any_of(type_->states, [&](const State& state) {
        return std::ranges::any_of(state.transitions,
                                   [&](const Transition& each) { return each.event == name; });
    });
    if (!known || !is_active_ || error_ || leaving_) return;
    if (!busy_ && !in_hand() && deferred_.empty() && wanted_.empty() && !paused_ && !final_wanted_) {
        open();
        react({name, arguments}, now);
        static_cast<void>(work(now));
        finish(now);
        return;
    }
    if (deferred_.size() == most_deferred) {
        count("event lost");
        ++lost_;
    } else {
        count(in_hand() ? "event deferred by a transition" : "event deferred");
        deferred_.push_back({name, arguments});
    }
    if (busy_) return;
    open();
    finish(now);
}

void Machine::finish(std::int64_t now) {
    for (std::size_t n = 0; n < most_deferred; ++n) {
        serve_final(now);
        if (!is_active_ || error_ || in_hand() || paused_) break;
        if (!wanted_.empty()) {
            static_cast<void>(serve_request(now));
        } else if (!deferred_.empty()) {
            const Event next = deferred_.front();
            deferred_.pop_front();
            react(next, now);
            static_cast<void>(work(now));
        } else {
            break;
        }
    }
    serve_final(now);
    busy_ = false;
}

} // namespace tappet::reference

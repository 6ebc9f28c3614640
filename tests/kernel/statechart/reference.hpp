// A second interpreter of the flat form, to compare the first with: it walks the states by name with maps and
// lists, each transition is a coroutine that stands still where a program waits, and it shares nothing with
// the resolver or the execution but the rows.
#pragma once

#include "tests/kernel/statechart/reference_tree.hpp"
#include "tests/kernel/statechart/reference_work.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tappet {

class ReferenceMachine : ReferenceTree {
public:
    using Answer = ReferenceAnswer;
    using Code = ReferenceCode;

    ReferenceMachine(StateMachineTable table, void* component, Code code = {})
        : ReferenceTree{table}, component_{component}, code_{std::move(code)} {}

    void activate(Time now) {
        if (on_) return;
        on_ = true;
        automatic_ = run_once_ = error_ = mid_ = left_ = final_wanted_ = false;
        active_.clear();
        raised_.clear();
        wanted_.reset();
        open(now);
        work_ = travel({.target = initial_top(), .enters_all = true});
        go_on();
        settle();
    }
    void start(Time now) {
        activate(now);
        automatic_ = on_;
    }
    void reactive() { automatic_ = false; }
    void deactivate(Time now) {
        if (!on_ || busy_ || (leaving_ && !error_)) return;
        raised_.clear();
        wanted_.reset();
        final_wanted_ = left_ = false;
        open(now);
        if (leaving_) leave(std::exchange(exit_in_hand_, {})); // without the program that failed
        supersede({.leaving = true});
        go_on();
        busy_ = false;
    }
    void dispatch(Name event, Time now, int argument = 0) {
        const auto names_it = [event](const TransitionRow& row) {
            return row.on_event && row.event == event;
        };
        if (!on_ || error_ || leaving_ || std::ranges::none_of(table_.transitions, names_it)) return;
        if (busy_ || work_ || !raised_.empty() || wanted_) {
            if (raised_.size() < 8)
                raised_.emplace_back(event, argument);
            else
                ++lost;
            if (busy_) return;
            open(now);
        } else {
            open(now);
            react(event, argument);
            go_on();
        }
        settle();
    }
    void step(Time now) {
        if (!on_ || busy_ || error_) return;
        open(now);
        stepped_at_ = now;
        left_ = false;
        ran_.clear();
        serve_final();
        round();
        settle();
    }
    void request_state(Name target, Time now, bool run_once) {
        if (!on_ || error_ || leaving_) return;
        if (wanted_) {
            ++lost;
            return;
        }
        wanted_ = {target, run_once};
        if (busy_ || work_ || !raised_.empty()) return;
        open(now);
        serve_request();
        settle();
    }
    void request_final(Time now, Name why) {
        if (!on_ || leaving_ || (in_final() && !busy_ && !work_ && !error_)) return;
        final_wanted_ = true;
        final_reason_ = why;
        if (busy_) return;
        open(now);
        settle();
    }
    void request_initial(Time now) {
        if (!on_ || busy_ || work_ || error_ || !in_final()) return;
        open(now);
        supersede({.target = initial_top(), .enters_all = true});
        go_on();
        settle();
    }

    /// "/x/a/c": the active states, each before those inside it.
    [[nodiscard]] std::string path() const {
        std::string text;
        for (Name name : listed()) text.append("/").append(name);
        return text;
    }
    [[nodiscard]] bool left_over() const { return left_ || ((!raised_.empty()) && !work_); }
    [[nodiscard]] bool is_active() const { return on_; }
    [[nodiscard]] bool has(Name name) const { return std::ranges::count(order_, name) != 0; }
    [[nodiscard]] bool in_error() const { return error_; }
    [[nodiscard]] bool under_way() const { return work_.has_value(); }
    [[nodiscard]] Time next_timeout() const {
        if (!on_ || error_) return never;
        if (left_over()) return stepped_at_;
        Time earliest = never;
        for (const TransitionRow& row : table_.transitions)
            if (automatic_ && !work_ && row.timed && active_.contains(row.from) && due(row) > stepped_at_)
                earliest = std::min(earliest, due(row));
        return earliest;
    }
    std::size_t transitions = 0;
    std::size_t lost = 0;
    std::string reason;

private:
    struct Trip {
        const TransitionRow* row = nullptr; ///< null: a request
        bool otherwise = false;
        bool leaving = false;
        Name target{};
        bool enters_all = false; ///< a request: everything is left
    };

    // ---- programs and conditions
    void leave(Name name) {
        last_[{state(name).parent, state(name).region}] = name;
        active_.erase(name);
        std::erase_if(pending_, [name](const Trip& trip) { return trip.row->from == name; });
    }

    Answer perform(const ProgramRef& program, int& stage) {
        if (program.call != nullptr) program.call(component_);
        if (program.program == no_program) return Answer::yes;
        const Answer answer = code_.run(program.program, stage);
        if (answer == Answer::failed) error_ = true;
        return answer;
    }
    Answer ask(const ConditionRef& condition) {
        if (condition.call != nullptr) return condition.call(component_) ? Answer::yes : Answer::no;
        return condition.condition == no_condition ? Answer::yes : code_.test(condition.condition);
    }
    Answer may_enter(Name from, Name to, EntryKind enters) {
        if (to.empty()) return Answer::yes;
        for (Name name : entries(to, shared(from, to), enters))
            if (const Answer answer = ask(state(name).precondition); answer != Answer::yes) return answer;
        return Answer::yes;
    }
    /// Whether the transition is taken; `otherwise`: by its else branch.
    Answer ask(const TransitionRow& row, int argument, bool& otherwise) {
        if (row.captures != 0) std::memcpy(code_.data, &argument, sizeof argument);
        Answer answer = ask(row.guard);
        if (answer == Answer::yes) answer = may_enter(row.from, row.to, row.enters);
        otherwise = answer == Answer::no && row.has_otherwise;
        if (otherwise) answer = may_enter(row.from, row.otherwise_to, EntryKind::initial);
        if (answer == Answer::failed) error_ = true;
        return answer;
    }
    [[nodiscard]] Time due(const TransitionRow& row) const {
        return active_.at(row.from).entered + row.after;
    }

    // ---- what may wait
    ReferenceWork travel(Trip trip) {
        int stage = 0;
        const TransitionRow* row = trip.row;
        if (row != nullptr) {
            if (!trip.otherwise && !row->because.empty()) reason = row->because;
            for (auto& [name, each] : active_)
                if (each.phase == Phase::asked) each.phase = Phase::ran;
            while (perform(trip.otherwise ? row->otherwise : row->then, stage) != Answer::yes || error_)
                co_await std::suspend_always{};
        }
        const std::size_t kept = row == nullptr || trip.target.empty() ? 0 : shared(row->from, trip.target);
        const Name root = row == nullptr ? Name{} : chain(row->from)[kept];
        const bool leaves = row == nullptr || !trip.target.empty();
        while (leaves) {
            Name last;
            for (Name name : listed())
                if (root.empty() || inside(name, root)) last = name;
            if (!exit_in_hand_.empty()) last = exit_in_hand_;
            if (last.empty()) break;
            if (exit_in_hand_.empty()) exit_stage_ = 0;
            exit_in_hand_ = last;
            while (perform(state(last).exit, exit_stage_) != Answer::yes || error_)
                co_await std::suspend_always{};
            exit_in_hand_ = {};
            leave(last);
        }
        if (trip.leaving) {
            on_ = automatic_ = leaving_ = false;
            ++transitions;
            co_return;
        }
        Names entering;
        if (leaves)
            entering = entries(trip.target, kept,
                               trip.row == nullptr || trip.otherwise ? EntryKind::initial : trip.row->enters);
        for (Name name : entering) {
            active_[name] = {Phase::fresh, 0, now_};
            stage = 0;
            while (perform(state(name).entry, stage) != Answer::yes || error_) co_await std::suspend_always{};
        }
        ++transitions;
    }
    ReferenceWork handle(Name name) {
        int stage = 0;
        while (perform(state(name).handle, stage) != Answer::yes || error_) co_await std::suspend_always{};
    }
    bool go_on() {
        for (;;) {
            if (error_) return false;
            if (work_) {
                const bool done = work_->resume();
                if (!done) return false;
                work_.reset();
                travelling_to_final_ = false;
            } else if (pending_.empty() || final_wanted_) {
                pending_.clear();
                return !error_;
            } else {
                Trip trip = pending_.front();
                pending_.pop_front();
                work_ = travel(trip);
            }
        }
    }
    void supersede(const Trip& trip) {
        pending_.clear();
        if (error_) exit_in_hand_ = {};
        error_ = run_once_ = false;
        leaving_ = trip.leaving;
        travelling_to_final_ = !trip.leaving && state(trip.target).final;
        work_ = travel(trip);
    }

    // ---- events
    bool react(Name event, int argument) {
        pending_.clear();
        std::optional<Name> refused;
        const bool taken = offer(initial_active(), event, argument, refused);
        if (error_) {
            pending_.clear();
            return false;
        }
        if (!taken && refused && !state(*refused).handle.empty()) work_ = handle(*refused);
        return taken;
    }
    [[nodiscard]] Name initial_active() const { return listed().front(); }
    bool offer(Name name, Name event, int argument, std::optional<Name>& refused) {
        bool taken = false;
        for (Name region : regions(name))
            if (const auto inner = child(name, region); inner && !error_)
                taken = offer(*inner, event, argument, refused) || taken;
        for (const TransitionRow& row : table_.transitions) {
            if (taken || error_ || row.from != name || !row.on_event || row.event != event) continue;
            bool otherwise = false;
            const Answer answer = ask(row, argument, otherwise);
            if (answer == Answer::no && !refused) refused = name;
            if (answer != Answer::yes) continue;
            pending_.push_back({&row, otherwise, false, otherwise ? row.otherwise_to : row.to});
            taken = true;
        }
        return taken;
    }

    // ---- a round
    void round() {
        if (!go_on() || !on_ || (!automatic_ && !run_once_)) return;
        for (auto& [name, each] : active_)
            if (each.phase == Phase::waits)
                each.phase = Phase::under_way;
            else if (!mid_ && each.phase != Phase::under_way)
                each.phase = Phase::fresh;
        mid_ = true;
        for (int taken = 0;;) {
            run_states();
            while (!error_ && final_wanted_) {
                serve_final();
                if (work_ || error_) return;
                run_states();
            }
            if (error_) return;
            if (!automatic_) break;
            const TransitionRow* row = condition(initial_active());
            if (error_) return;
            if (row == nullptr) break;
            work_ = travel({.row = row, .target = row->to});
            if (!go_on()) return;
            if (final_wanted_) serve_final();
            if (work_ || error_) return;
            left_ = ++taken == 8;
            if (left_) {
                mid_ = false;
                return;
            }
        }
        if (automatic_) {
            for (auto& [name, each] : active_)
                if (each.phase == Phase::ran) each.phase = Phase::asked;
            for (Name name : listed()) {
                if (active_.at(name).phase != Phase::asked) continue;
                active_.at(name).phase = Phase::done;
                if (state(name).handle.empty()) continue;
                work_ = handle(name);
                if (!go_on()) return;
            }
        } else
            for (const auto& [name, each] : active_)
                if (each.phase == Phase::waits) return;
        mid_ = run_once_ = false;
    }
    void run_states() {
        for (Name name : listed()) {
            Active& at = active_.at(name);
            const ProgramRef& program = state(name).run;
            if (error_ || (at.phase != Phase::fresh && at.phase != Phase::under_way)) continue;
            if (at.phase == Phase::fresh && !program.empty() && ran_.contains(name)) {
                at.phase = Phase::held;
                continue;
            }
            if (at.phase == Phase::fresh) at.stage = 0;
            at.phase = Phase::ran;
            if (program.empty()) continue;
            ran_.insert(name);
            const Answer answer = perform(program, at.stage);
            if (answer == Answer::waits) at.phase = Phase::waits;
            if (answer == Answer::failed) at.phase = Phase::under_way;
        }
    }
    const TransitionRow* condition(Name name) {
        for (Name region : regions(name))
            if (const auto inner = child(name, region); inner && !error_)
                if (const TransitionRow* found = condition(*inner)) return found;
        const Phase phase = active_.at(name).phase;
        for (const TransitionRow& row : table_.transitions) {
            if (error_ || row.from != name || row.on_event) continue;
            if (phase != Phase::ran && !(phase == Phase::waits && row.timed)) continue;
            if (row.timed && now_ < due(row)) continue;
            bool otherwise = false;
            if (ask(row, 0, otherwise) == Answer::yes) return &row;
        }
        return nullptr;
    }

    // ---- requests
    void open(Time now) {
        busy_ = true;
        now_ = now;
    }
    void serve_final() {
        if (!std::exchange(final_wanted_, false)) return;
        if (!on_ || leaving_ || (travelling_to_final_ && work_ && !error_)) return;
        if (in_final() && !work_ && !error_) return;
        if (!final_reason_.empty()) reason = final_reason_;
        for (const StateRow& row : table_.states)
            if (row.final) supersede({.target = row.name, .enters_all = true});
        go_on();
        if (in_final() && !work_ && !error_) final_wanted_ = false;
    }
    void serve_request() {
        const auto [target, run_once] = *std::exchange(wanted_, std::nullopt);
        bool there = active_.contains(target);
        if (!there && (state(target).final || (in_final() && target == initial_top()))) {
            supersede({.target = target, .enters_all = true});
            there = true;
        }
        for (Name name : leaves()) {
            for (Name source = name; !there && !source.empty(); source = state(source).parent)
                for (const TransitionRow& row : table_.transitions) {
                    if (there || row.from != source || row.on_event || row.to != target) continue;
                    if (row.timed && now_ < due(row)) continue;
                    bool otherwise = false;
                    const Answer answer = ask(row, 0, otherwise);
                    if (answer == Answer::failed) return;
                    there = answer == Answer::yes;
                    if (there) work_ = travel({.row = &row, .target = row.to});
                }
        }
        if (!there) return;
        run_once_ = run_once && !automatic_;
        if (!go_on() || !run_once_) return;
        ran_.clear();
        round();
    }
    [[nodiscard]] Names leaves() const {
        Names found;
        for (Name name : listed())
            if (regions(name).empty()) found.push_back(name);
        return found;
    }
    void settle() {
        busy_ = true;
        for (int n = 0; n < 8; ++n) {
            serve_final();
            if (!on_ || error_ || work_) break;
            if (wanted_)
                serve_request();
            else if (!raised_.empty()) {
                const auto [event, argument] = raised_.front();
                raised_.pop_front();
                react(event, argument);
                go_on();
            } else
                break;
        }
        serve_final();
        busy_ = false;
    }

    void* component_;
    Code code_;
    std::optional<ReferenceWork> work_;
    std::deque<Trip> pending_; // taken by one event, by region
    std::set<Name> ran_;
    std::deque<std::pair<std::string, int>> raised_;
    std::optional<std::pair<Name, bool>> wanted_;
    std::string final_reason_;
    Name exit_in_hand_;
    int exit_stage_ = 0;
    Time now_{};
    Time stepped_at_{};
    bool on_ = false;
    bool automatic_ = false;
    bool run_once_ = false;
    bool mid_ = false; // of a round
    bool busy_ = false;
    bool leaving_ = false;
    bool error_ = false;
    bool travelling_to_final_ = false;
    bool final_wanted_ = false;
    bool left_ = false;
};

} // namespace tappet
